// What an experiment found: rows of measured against theory, curves and pictures. The report, the
// text table, the JSON and the tests are all made from it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/math/types.h"

namespace scree::verify {

/// What hangs on a row.
enum class Weight {
    must,       ///< gates a release
    goal,       ///< is reported
    control,    ///< a run that has to fail in the stated way, so that the experiment can see
    departure,  ///< a demand that is known not to be met; the note says why. Never hidden, not
                ///< gated
};

enum class Verdict { pass, fail, reported, notRun };

struct Measurement {
    std::string what;
    double measured = 0.0;
    std::string unit;
    std::string theory;     ///< "-" where there is none
    std::string tolerance;  ///< as a condition on the measured value
    Verdict verdict = Verdict::reported;
    Weight weight = Weight::must;
    std::string note;
};

struct Curve {
    std::string name;
    std::vector<double> x, y;
    bool isTheory = false;  ///< dashed and dark, drawn on top
};

struct Plot {
    std::string title, xLabel, yLabel;
    std::vector<Curve> curves;
};

struct Picture {
    std::string caption;
    std::vector<std::uint8_t> png;
};

/// Collects what is found. A bound is checked where it is stated, so that the table cannot say
/// another tolerance than the one that was applied.
class Findings {
public:
    void atMost(Weight weight, const std::string& what, double measured, double bound,
                const std::string& unit, const std::string& note = "");
    void atLeast(Weight weight, const std::string& what, double measured, double bound,
                 const std::string& unit, const std::string& note = "");
    void near(Weight weight, const std::string& what, double measured, double theory,
              double tolerance, const std::string& unit, const std::string& note = "");
    /// Counts, which are right or wrong.
    void equal(Weight weight, const std::string& what, double measured, double theory,
               const std::string& note = "");
    /// A number without a bound.
    void report(const std::string& what, double measured, const std::string& unit,
                const std::string& note = "");
    /// A demand that this version cannot be held against; the note says what is missing.
    void notRun(Weight weight, const std::string& what, const std::string& note);

    std::vector<Measurement> rows;
    std::vector<Plot> plots;
    std::vector<Picture> pictures;

private:
    void add(Weight weight, const std::string& what, double measured, const std::string& unit,
             const std::string& theory, const std::string& tolerance, bool holds,
             const std::string& note);
};

/// Whether a row breaks the release: a must that fails, a control that does not see.
bool isBroken(const Measurement& row);
/// Whether a must could not be run, which is no pass either.
bool isMissing(const Measurement& row);

const char* nameOf(Weight weight);
const char* nameOf(Verdict verdict);

/// The larger or smaller of two figures. What is no number beats both: the standard library's keep
/// the other one, and a broken run would pass its bounds.
double larger(double a, double b);
double smaller(double a, double b);

/// Four digits, as a person reads them.
std::string shortNumber(double value);

}  // namespace scree::verify
