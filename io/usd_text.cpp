#include "io/usd_text.h"

#include "core/base/check.h"

namespace scree {

namespace {

constexpr std::string_view kStep = "    ";

}  // namespace

void UsdText::openPrim(std::string_view head, const std::vector<std::string>& metadata)
{
    if (metadata.empty()) {
        line(head);
    } else {
        line(std::string(head) + " (");
        indent_ += kStep;
        for (const std::string& entry : metadata) line(entry);
        indent_.resize(indent_.size() - kStep.size());
        line(")");
    }
    line("{");
    indent_ += kStep;
}

void UsdText::closePrim()
{
    SCREE_CHECK(!indent_.empty(), "a prim closed that was not opened");
    indent_.resize(indent_.size() - kStep.size());
    line("}");
}

void UsdText::line(std::string_view text)
{
    if (!text.empty()) file_.write(indent_);
    file_.write(text);
    file_.write("\n");
}

void UsdText::openTimes(std::string_view attribute)
{
    line(std::string(attribute) + ".timeSamples = {");
    indent_ += kStep;
}

void UsdText::time(double time, std::string_view value)
{
    file_.write(indent_ + numberText(time) + ": ");
    file_.write(value);
    file_.write(",\n");
}

void UsdText::closeTimes()
{
    closePrim();
}

std::string usdPrim(std::string_view type, std::string_view name)
{
    return "def " + std::string(type) + " \"" + std::string(name) + "\"";
}

std::string usdString(std::string_view text)
{
    std::string quoted = "\"";
    for (const char letter : text) {
        if (letter == '\n') {
            quoted += "\\n";
            continue;
        }
        if (letter == '"' || letter == '\\') quoted += '\\';
        quoted += letter;
    }
    return quoted += '"';
}

Eigen::Vector4d usdQuaternion(const Quat& orientation)
{
    return {orientation.w(), orientation.x(), orientation.y(), orientation.z()};
}

}  // namespace scree
