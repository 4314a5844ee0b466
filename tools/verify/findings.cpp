#include "tools/verify/findings.h"

#include <cmath>
#include <cstdio>

namespace scree::verify {

void Findings::add(Weight weight, const std::string& what, double measured, const std::string& unit,
                   const std::string& theory, const std::string& tolerance, bool holds,
                   const std::string& note)
{
    Verdict verdict = holds ? Verdict::pass : Verdict::fail;
    // A goal and a known departure are told, whatever came out; only a pass is worth a verdict.
    const bool isTold = weight == Weight::goal || weight == Weight::departure;
    if (!holds && isTold) verdict = Verdict::reported;
    rows.push_back({what, measured, unit, theory, tolerance, verdict, weight, note});
}

void Findings::atMost(Weight weight, const std::string& what, double measured, double bound,
                      const std::string& unit, const std::string& note)
{
    add(weight, what, measured, unit, "-", "<= " + shortNumber(bound), measured <= bound, note);
}

void Findings::atLeast(Weight weight, const std::string& what, double measured, double bound,
                       const std::string& unit, const std::string& note)
{
    add(weight, what, measured, unit, "-", ">= " + shortNumber(bound), measured >= bound, note);
}

void Findings::near(Weight weight, const std::string& what, double measured, double theory,
                    double tolerance, const std::string& unit, const std::string& note)
{
    add(weight, what, measured, unit, shortNumber(theory), "+- " + shortNumber(tolerance),
        std::abs(measured - theory) <= tolerance, note);
}

void Findings::equal(Weight weight, const std::string& what, double measured, double theory,
                     const std::string& note)
{
    add(weight, what, measured, "", shortNumber(theory), "equal", measured == theory, note);
}

void Findings::report(const std::string& what, double measured, const std::string& unit,
                      const std::string& note)
{
    rows.push_back({what, measured, unit, "-", "-", Verdict::reported, Weight::goal, note});
}

void Findings::notRun(Weight weight, const std::string& what, const std::string& note)
{
    rows.push_back({what, std::nan(""), "", "-", "-", Verdict::notRun, weight, note});
}

bool isBroken(const Measurement& row)
{
    const bool gates = row.weight == Weight::must || row.weight == Weight::control;
    return gates && row.verdict == Verdict::fail;
}

bool isMissing(const Measurement& row)
{
    return row.weight == Weight::must && row.verdict == Verdict::notRun;
}

const char* nameOf(Weight weight)
{
    switch (weight) {
        case Weight::must:
            return "must";
        case Weight::goal:
            return "goal";
        case Weight::control:
            return "control";
        case Weight::departure:
            return "departure";
    }
    return "";
}

const char* nameOf(Verdict verdict)
{
    switch (verdict) {
        case Verdict::pass:
            return "pass";
        case Verdict::fail:
            return "FAIL";
        case Verdict::reported:
            return "reported";
        case Verdict::notRun:
            return "not run";
    }
    return "";
}

double larger(double a, double b)
{
    return std::isnan(a) || b <= a ? a : b;
}

double smaller(double a, double b)
{
    return std::isnan(a) || b >= a ? a : b;
}

std::string shortNumber(double value)
{
    if (std::isnan(value)) return "-";
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

}  // namespace scree::verify
