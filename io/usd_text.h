// The text form of USD: prims with their metadata, and values as USD spells them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/math/types.h"
#include "io/atomic_file.h"
#include "io/number_text.h"

namespace scree {

/// Writes nested prims; keeps the indentation.
class UsdText {
public:
    explicit UsdText(AtomicFile& file) : file_(file) {}

    /// `head` is a specifier with type and name (`def Xform "ring"`); metadata one line each.
    void openPrim(std::string_view head, const std::vector<std::string>& metadata = {});
    void closePrim();

    void line(std::string_view text);

    /// Times of an attribute, each with its value: `type name.timeSamples = {`, samples, `}`.
    void openTimes(std::string_view attribute);
    void time(double time, std::string_view value);
    void closeTimes();

private:
    AtomicFile& file_;
    std::string indent_;
};

/// def <type> "<name>"
std::string usdPrim(std::string_view type, std::string_view name);

/// A string with quotes; whatever would end it or a line is escaped.
std::string usdString(std::string_view text);

/// "(1, 2, 3)"; a vector of float has the digits of a float.
template <class Vector>
void appendUsdTuple(std::string& text, const Vector& vector)
{
    char before = '(';
    for (const auto coordinate : vector) {
        text += before;
        if (before == ',') text += ' ';
        appendNumber(text, coordinate);
        before = ',';
    }
    text += ')';
}

template <class Vector>
std::string usdTuple(const Vector& vector)
{
    std::string text;
    appendUsdTuple(text, vector);
    return text;
}

/// Order w, x, y, z, as USD's text has it. To be written as `quatd` wherever USD allows: it takes
/// the angle from w alone, and in `quatf` any turn below 0.04° has w = 1 and is lost.
Eigen::Vector4d usdQuaternion(const Quat& orientation);

/// "[" + values + "]"; `append(text, value)` writes one.
template <class Range, class Append>
std::string usdArray(const Range& values, Append append)
{
    std::string text = "[";
    for (const auto& value : values) {
        if (text.size() > 1) text += ", ";
        append(text, value);
    }
    return text += ']';
}

}  // namespace scree
