// Curves as SVG: axes with round numbers, a legend, theory dashed on top.
#pragma once

#include <string>

#include "tools/verify/findings.h"

namespace scree::verify {

/// An <svg> element that needs nothing outside itself; equal plots give equal text.
std::string toSvg(const Plot& plot);

/// The largest of 1, 2 and 5 times a power of ten that divides `span` into at least four.
double niceStep(double span);

}  // namespace scree::verify
