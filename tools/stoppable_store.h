// Signals while the shapes of a shot are made, which can take minutes.
#pragma once

#include <mutex>

#include "core/geometry/shape_store.h"
#include "tools/console.h"

namespace scree {

/// Passes on to a store what is asked of it. It is asked before a solid or a distance field is made
/// and told after: the places where signals are heeded while the world comes about, when there is
/// nothing to save yet: throws Stopped.
class StoppableStore : public ShapeStore {
public:
    StoppableStore(ShapeStore& store, Console& console) : store_(store), console_(console) {}

    std::optional<DistanceField> findField(std::uint64_t key) override;
    void keepField(std::uint64_t key, const DistanceField& field) override;
    std::optional<TriMesh> findSolid(std::uint64_t key) override;
    void keepSolid(std::uint64_t key, const TriMesh& solid) override;

    void heedSignals();

private:
    ShapeStore& store_;
    Console& console_;
    std::mutex lock_;  // several threads make shapes
};

}  // namespace scree
