// What the program returns, so that a farm can tell what to do next. The numbers are those of
// sysexits.h where it has one.
#pragma once

#include "core/base/error.h"

namespace scree {

constexpr int kExitDone = 0;
constexpr int kExitDiffers = 1;  ///< of diff alone, as every diff does it
constexpr int kExitUsage = 64;
constexpr int kExitInternal = 70;
/// Stopped when asked to, and nothing is wrong: a farm runs the same again. sim and settle have
/// saved their state and go on with --resume, the others begin anew.
constexpr int kExitStopped = 75;
constexpr int kExitQuality = 79;

constexpr int exitCodeFor(ErrorKind kind)
{
    switch (kind) {
        case ErrorKind::usage:
            return kExitUsage;
        case ErrorKind::badInput:
            return 65;
        case ErrorKind::missingInput:
            return 66;
        case ErrorKind::internal:
            return kExitInternal;
        case ErrorKind::cannotCreate:
            return 73;
        case ErrorKind::inputOutput:
            return 74;
        case ErrorKind::qualityLimit:
            return kExitQuality;
    }
    return kExitInternal;
}

}  // namespace scree
