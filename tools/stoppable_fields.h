// Signals while the distance fields of a shot are built, which can take minutes.
#pragma once

#include "core/geometry/field_store.h"
#include "tools/console.h"

namespace scree {

/// Passes on to a store what is asked of it. It is asked before a distance field is built and told
/// after: the places where signals are heeded while the world comes about, when there is nothing to
/// save yet: throws Stopped.
class StoppableFields : public FieldStore {
public:
    StoppableFields(FieldStore& fields, Console& console) : fields_(fields), console_(console) {}

    std::optional<DistanceField> find(std::uint64_t key) override;
    void keep(std::uint64_t key, const DistanceField& field) override;

    void heedSignals();

private:
    FieldStore& fields_;
    Console& console_;
};

}  // namespace scree
