#include "tools/verify/report.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/command_line.h"
#include "tools/html_text.h"
#include "tools/verify/plot.h"
#include "tools/version.h"

namespace scree::verify {
namespace {

constexpr const char* kStyle = R"(<style>
body { font: 15px/1.45 sans-serif; max-width: 1100px; margin: 2em auto; padding: 0 1em; color: #222 }
h2 { margin-top: 2.2em; border-bottom: 1px solid #ccc }
table { border-collapse: collapse; width: 100%; font-size: 13px }
td, th { padding: 3px 8px; text-align: left; border-bottom: 1px solid #e4e4e4; vertical-align: top }
td.number { text-align: right; white-space: nowrap }
.note { color: #666 }
.pass { color: #1b7a3d } .FAIL { color: #fff; background: #c22 } .not { color: #a05a00 }
.figures { display: flex; flex-wrap: wrap; gap: 16px; margin: 1em 0 }
figure { margin: 0; flex: 1 1 420px; max-width: 640px }
figure img, figure svg { width: 100%; height: auto; border: 1px solid #ddd }
figcaption { font-size: 13px; color: #444 }
.paper { font-style: italic; color: #444 }
</style>
)";

std::string rowHtml(const Measurement& row)
{
    const std::string verdict = nameOf(row.verdict);
    std::string html = "<tr><td>" + escapedForHtml(row.what);
    if (!row.note.empty())
        html += "<br><span class=\"note\">" + escapedForHtml(row.note) + "</span>";
    html +=
        "</td><td class=\"number\">" + shortNumber(row.measured) + " " + escapedForHtml(row.unit);
    html += "</td><td>" + escapedForHtml(row.theory) + "</td><td>" + escapedForHtml(row.tolerance) +
            "</td><td>" + nameOf(row.weight) + "</td>";
    html +=
        "<td class=\"" + verdict.substr(0, verdict.find(' ')) + "\">" + verdict + "</td></tr>\n";
    return html;
}

std::string figuresHtml(const Findings& findings)
{
    if (findings.plots.empty() && findings.pictures.empty()) return "";
    std::string html = "<div class=\"figures\">\n";
    for (const Plot& plot : findings.plots) html += "<figure>" + toSvg(plot) + "</figure>\n";
    for (const Picture& picture : findings.pictures) {
        html += "<figure><img alt=\"" + escapedForHtml(picture.caption) +
                "\" src=\"data:image/png;base64," + base64(picture.png) + "\"><figcaption>" +
                escapedForHtml(picture.caption) + "</figcaption></figure>\n";
    }
    return html + "</div>\n";
}

std::string sectionHtml(const Result& result)
{
    const Experiment& experiment = *result.experiment;
    const std::string id = experiment.id;
    std::string html = "<h2 id=\"" + id + "_" + result.method + "\">" + id + " " +
                       escapedForHtml(experiment.title) + "</h2>\n<p>" +
                       escapedForHtml(experiment.claim) + " Method " + result.method + ", " +
                       (experiment.isMust ? "must" : "goal") + ", " +
                       describeDuration(result.cpuSeconds) + " of processor.</p>\n";
    if (*experiment.paper) {
        html += "<p class=\"paper\">In the paper: " + escapedForHtml(experiment.paper) + "</p>\n";
    }
    html +=
        "<table><tr><th>what</th><th>measured</th><th>theory</th><th>tolerance</th>"
        "<th>weight</th><th>verdict</th></tr>\n";
    for (const Measurement& row : result.findings.rows) html += rowHtml(row);
    return html + "</table>\n" + figuresHtml(result.findings);
}

}  // namespace

Summary summarize(const std::vector<Result>& results)
{
    Summary summary;
    for (const Result& result : results) {
        for (const Measurement& row : result.findings.rows) {
            ++summary.rows;
            summary.passed += row.verdict == Verdict::pass;
            summary.broken += isBroken(row);
            summary.missing += isMissing(row);
            summary.departures +=
                row.weight == Weight::departure && row.verdict == Verdict::reported;
        }
    }
    return summary;
}

std::string toText(const Result& result)
{
    std::string text = std::string(result.experiment->id) + "  " + result.experiment->title + " (" +
                       result.method + ", " + describeDuration(result.cpuSeconds) + ")\n";
    char line[256];
    for (const Measurement& row : result.findings.rows) {
        const std::string measured = shortNumber(row.measured) + " " + row.unit;
        std::snprintf(line, sizeof line, "  %-66s %18s  theory %-8s %-14s %-9s %s\n",
                      row.what.c_str(), measured.c_str(), row.theory.c_str(), row.tolerance.c_str(),
                      nameOf(row.weight), nameOf(row.verdict));
        text += line;
        if (!row.note.empty() && row.verdict != Verdict::pass) text += "      " + row.note + "\n";
    }
    return text;
}

std::string toText(const Summary& summary)
{
    return std::to_string(summary.rows) + " rows: " + std::to_string(summary.passed) + " pass, " +
           std::to_string(summary.broken) + " musts or controls fail, " +
           std::to_string(summary.missing) + " musts could not be run, " +
           std::to_string(summary.departures) + " known departures\n";
}

std::string toJson(const std::vector<Result>& results)
{
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const Result& result : results) {
        nlohmann::ordered_json rows = nlohmann::ordered_json::array();
        for (const Measurement& row : result.findings.rows) {
            // A demand that was not run has no number; NaN is none in JSON.
            const nlohmann::ordered_json measured =
                std::isfinite(row.measured) ? nlohmann::ordered_json(row.measured) : nullptr;
            rows.push_back({{"what", row.what},
                            {"measured", measured},
                            {"unit", row.unit},
                            {"theory", row.theory},
                            {"tolerance", row.tolerance},
                            {"weight", nameOf(row.weight)},
                            {"verdict", nameOf(row.verdict)},
                            {"note", row.note}});
        }
        json.push_back({{"id", result.experiment->id},
                        {"title", result.experiment->title},
                        {"method", result.method},
                        {"cpu_s", result.cpuSeconds},
                        {"rows", rows}});
    }
    return json.dump(2) + "\n";
}

std::string toHtml(const std::vector<Result>& results, const Context& context)
{
    std::string html =
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
        "<title>scree verify</title>\n";
    html += kStyle;
    html += "</head><body>\n<h1>The experiments of Scree " + programVersion() + "</h1>\n<p>" +
            (context.isFull() ? "Full form. " : "Brief form. ") +
            escapedForHtml(toText(summarize(results))) + "</p>\n<ul>\n";
    for (const Result& result : results) {
        const Summary summary = summarize({result});
        html += std::string("<li><a href=\"#") + result.experiment->id + "_" + result.method +
                "\">" + result.experiment->id + " " + escapedForHtml(result.experiment->title) +
                "</a>, " + result.method + ": " + std::to_string(summary.passed) + " of " +
                std::to_string(summary.rows) + " rows pass" +
                (summary.broken ? ", <b>" + std::to_string(summary.broken) + " fail</b>" : "") +
                (summary.missing ? ", " + std::to_string(summary.missing) + " not run" : "") +
                "</li>\n";
    }
    html += "</ul>\n";
    for (const Result& result : results) html += sectionHtml(result);
    return html + "</body></html>\n";
}

}  // namespace scree::verify
