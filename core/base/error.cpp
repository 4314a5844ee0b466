#include "core/base/error.h"

namespace scree {

std::string toString(const SourceLocation& location)
{
    std::string text = location.file;
    if (location.line > 0) text += ":" + std::to_string(location.line);
    if (location.line > 0 && location.column > 0) text += ":" + std::to_string(location.column);
    return text;
}

Error::Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind)
{
}

Error::Error(ErrorKind kind, const SourceLocation& location, const std::string& message)
    : std::runtime_error(toString(location) + ": " + message), kind_(kind)
{
}

}  // namespace scree
