// How a call refuses: what tests ask of an Error.
#pragma once

#include <optional>
#include <string>

#include "core/base/error.h"

namespace scree::test {

struct Refusal {
    std::optional<ErrorKind> kind;  ///< none: nothing was thrown
    std::string message = "nothing was thrown";

    bool mentions(const std::string& words) const
    {
        return message.find(words) != std::string::npos;
    }
};

template <class Action>
Refusal refusalBy(const Action& action)
{
    try {
        action();
    } catch (const Error& error) {
        return {error.kind(), error.what()};
    }
    return {};
}

/// The kind alone; none where nothing is thrown.
template <class Action>
std::optional<ErrorKind> kindThrownBy(const Action& action)
{
    return refusalBy(action).kind;
}

}  // namespace scree::test
