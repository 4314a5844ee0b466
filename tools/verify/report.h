// What the experiments found, for a terminal, for a program and for a browser.
#pragma once

#include <string>
#include <vector>

#include "tools/verify/experiment.h"

namespace scree::verify {

struct Result {
    const Experiment* experiment = nullptr;
    std::string method;
    Findings findings;
    double cpuSeconds = 0.0;
};

struct Summary {
    int rows = 0, passed = 0, broken = 0, missing = 0, departures = 0;

    /// All musts pass and all controls fail as stated; a must that could not be run is no pass.
    bool isComplete() const { return broken == 0 && missing == 0; }
};
Summary summarize(const std::vector<Result>& results);

/// The rows of one experiment, in columns.
std::string toText(const Result& result);
std::string toText(const Summary& summary);

std::string toJson(const std::vector<Result>& results);

/// A page that needs nothing outside itself: pictures are part of it.
std::string toHtml(const std::vector<Result>& results, const Context& context);

}  // namespace scree::verify
