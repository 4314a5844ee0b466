#include "tools/verify/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/html_text.h"

namespace scree::verify {
namespace {

constexpr double kWidth = 640.0, kHeight = 340.0;
constexpr double kLeft = 64.0, kRight = 16.0, kTop = 34.0, kBottom = 48.0;
constexpr const char* kColors[] = {"#1f6fb4", "#d1495b", "#2e8b57", "#8e5aa8", "#c77d1e"};

/// More points than pixels only make the file large.
constexpr std::size_t kMostPoints = 600;

struct Range {
    double low = 1e300, high = -1e300;

    void include(double value)
    {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    void makeRound()
    {
        if (!(low < high)) high = low + 1.0;
        const double step = niceStep(high - low);
        low = std::floor(low / step) * step;
        high = std::ceil(high / step) * step;
    }
};

std::string number(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.1f", value);
    return text;
}

std::string label(double x, double y, const char* anchor, const std::string& text,
                  const std::string& more = "")
{
    return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\"" +
           more + ">" + escapedForHtml(text) + "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2, const char* style)
{
    return "<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) +
           "\" y2=\"" + number(y2) + "\" " + style + "/>\n";
}

class Drawing {
public:
    explicit Drawing(const Plot& plot) : plot_(plot)
    {
        for (const Curve& curve : plot.curves) {
            for (double x : curve.x) x_.include(x);
            for (double y : curve.y) y_.include(y);
        }
        x_.makeRound();
        y_.makeRound();
    }

    std::string text() const
    {
        std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " +
                          number(kWidth) + " " + number(kHeight) +
                          "\" font-family=\"sans-serif\" font-size=\"12\">\n";
        svg += label(kWidth / 2, 16, "middle", plot_.title, " font-weight=\"bold\"");
        svg += axes();
        // Theory last: on top.
        for (bool isTheory : {false, true}) {
            for (std::size_t i = 0; i < plot_.curves.size(); ++i) {
                if (plot_.curves[i].isTheory == isTheory) svg += curve(plot_.curves[i], i);
            }
        }
        return svg + legend() + "</svg>\n";
    }

private:
    double across(double x) const
    {
        return kLeft + (x - x_.low) / (x_.high - x_.low) * (kWidth - kLeft - kRight);
    }
    double down(double y) const
    {
        return kHeight - kBottom - (y - y_.low) / (y_.high - y_.low) * (kHeight - kTop - kBottom);
    }

    std::string axes() const
    {
        std::string svg;
        const double xStep = niceStep(x_.high - x_.low), yStep = niceStep(y_.high - y_.low);
        for (int i = 0; x_.low + i * xStep < x_.high + 0.5 * xStep; ++i) {
            const double x = x_.low + i * xStep;
            svg += line(across(x), kTop, across(x), kHeight - kBottom, "stroke=\"#ddd\"");
            svg += label(across(x), kHeight - kBottom + 16, "middle",
                         shortNumber(std::abs(x) < 1e-9 * xStep ? 0.0 : x));
        }
        for (int i = 0; y_.low + i * yStep < y_.high + 0.5 * yStep; ++i) {
            const double y = y_.low + i * yStep;
            svg += line(kLeft, down(y), kWidth - kRight, down(y), "stroke=\"#ddd\"");
            svg += label(kLeft - 6, down(y) + 4, "end",
                         shortNumber(std::abs(y) < 1e-9 * yStep ? 0.0 : y));
        }
        const double middle = 0.5 * (kTop + kHeight - kBottom);
        svg += label(0.5 * (kLeft + kWidth - kRight), kHeight - 10, "middle", plot_.xLabel);
        svg += label(14, middle, "middle", plot_.yLabel,
                     " transform=\"rotate(-90 14 " + number(middle) + ")\"");
        return svg;
    }

    std::string curve(const Curve& curve, std::size_t index) const
    {
        std::string points;
        const std::size_t count = std::min(curve.x.size(), curve.y.size());
        const std::size_t stride = 1 + count / kMostPoints;
        for (std::size_t i = 0; i < count; i += stride) {
            points += number(across(curve.x[i])) + "," + number(down(curve.y[i])) + " ";
        }
        return "<polyline fill=\"none\" " + stroke(index) + " points=\"" + points + "\"/>\n";
    }

    std::string stroke(std::size_t index) const
    {
        if (plot_.curves[index].isTheory) {
            return "stroke=\"#222\" stroke-width=\"1.2\" stroke-dasharray=\"5 4\"";
        }
        return std::string("stroke=\"") + kColors[index % std::size(kColors)] +
               "\" stroke-width=\"2.5\"";
    }

    std::string legend() const
    {
        std::string svg;
        for (std::size_t i = 0; i < plot_.curves.size(); ++i) {
            const double y = kTop + 14 + 16 * static_cast<double>(i);
            svg += line(kLeft + 10, y - 4, kLeft + 34, y - 4, stroke(i).c_str());
            svg += label(kLeft + 40, y, "start", plot_.curves[i].name);
        }
        return svg;
    }

    const Plot& plot_;
    Range x_, y_;
};

}  // namespace

std::string toSvg(const Plot& plot)
{
    return Drawing(plot).text();
}

double niceStep(double span)
{
    const double power = std::pow(10.0, std::floor(std::log10(span)));
    for (double share : {2.0, 1.0, 0.5}) {
        if (span / (share * power) >= 4.0) return share * power;
    }
    return 0.2 * power;
}

}  // namespace scree::verify
