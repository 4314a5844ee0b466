#include "io/shot_schema_keys.h"

namespace scree {

const std::vector<ShotKey>& shotKeys()
{
    static const std::vector<ShotKey> all = [] {
        std::vector<ShotKey> keys;
        appendSetupKeys(keys);
        appendSolidsKeys(keys);
        appendWorldKeys(keys);
        appendLookKeys(keys);
        return keys;
    }();
    return all;
}

}  // namespace scree
