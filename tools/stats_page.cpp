// The page's text is one template; data are put where {{NAME}} stands. Plots are drawn by the page
// itself, on canvases, so that they follow the width of the window and the reader's colours.
#include "tools/stats_page.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "io/text_forms.h"
#include "tools/html_text.h"

namespace scree {
namespace {

constexpr const char* kPage = R"html(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{{TITLE}}</title>
<style>
:root { color-scheme: light dark; --paper: #fbfbf9; --ink: #23262b; --faint: #8a8f98; --line: #dcdcd6;
        --a: #b4541c; --b: #2563a8; --c: #2f7d4f; --d: #8b3f8f; --e: #a58a12; --f: #4a4f9c; --g: #777; }
@media (prefers-color-scheme: dark) {
  :root { --paper: #15171a; --ink: #e4e5e7; --faint: #868b94; --line: #30343a;
          --a: #f0904f; --b: #6fb0f2; --c: #6fcf97; --d: #d68bd9; --e: #e3c84a; --f: #9aa0f5; --g: #aaa; }
}
body { margin: 0 auto; padding: 1.5rem; max-width: 78rem; background: var(--paper); color: var(--ink);
       font: 15px/1.45 system-ui, sans-serif; }
h1 { font-size: 1.5rem; margin: 0 0 .2rem; } h2 { font-size: 1rem; margin: 1.2rem 0 .2rem; }
p.facts { color: var(--faint); margin: 0 0 1rem; }
#top { display: flex; gap: 1.5rem; flex-wrap: wrap; align-items: flex-start; }
#picture { width: 480px; max-width: 100%; border: 1px solid var(--line); background: #555; }
#figures { border-collapse: collapse; font-variant-numeric: tabular-nums; }
#figures td { padding: .1rem .8rem .1rem 0; } #figures td:first-child { color: var(--faint); }
#plots { display: grid; grid-template-columns: repeat(auto-fit, minmax(26rem, 1fr)); gap: 0 1.5rem; }
canvas { width: 100%; height: 190px; display: block; cursor: crosshair; }
.keys { color: var(--faint); font-size: .85rem; } .keys b { font-weight: 600; }
pre { overflow: auto; border: 1px solid var(--line); padding: 1rem; font-size: 13px; }
</style>
</head>
<body>
<h1>{{TITLE}}</h1>
<p class="facts">{{FACTS}}</p>
<div id="top"><img id="picture" alt="the frame under the cursor"><table id="figures"></table></div>
<p class="keys">Move over a plot, or use the arrow keys, to choose a frame.</p>
<div id="plots"></div>
<h2>The resolved shot</h2>
<pre>{{SHOT}}</pre>
<script type="application/json" id="stats">{{STATS}}</script>
<script type="application/json" id="thumbnails">{{THUMBNAILS}}</script>
<script>
'use strict';
// What is not finite is written as null.
const read = id => JSON.parse(document.getElementById(id).textContent, (key, value) => value === null ? Infinity : value);
const stats = read('stats'), thumbnails = read('thumbnails');
const phases = stats.length ? Object.keys(stats[stats.length - 1].phase_ms || {}) : [];
const plots = [
  {title: 'Energy', unit: 'J', series: [['kinetic', s => s.kinetic_energy_J], ['potential', s => s.potential_energy_J]]},
  {title: 'Kinetic energy', unit: 'J', series: [['kinetic', s => s.kinetic_energy_J]]},
  {title: 'Contacts', unit: '', series: [['contact pairs', s => s.contact_pairs], ['touching pairs', s => s.touching_pairs]]},
  {title: 'Worst overlap', unit: '%', series: [['of the smaller body', s => 100 * s.overlap.worst_ratio]]},
  {title: 'Bodies awake', unit: '', series: [['awake', s => s.bodies_awake]]},
  {title: 'Time steps', unit: '', series: [['sub-steps', s => s.substeps]]},
  {title: 'Time by phase', unit: 'ms', series: phases.map(p => [p.replace(/_/g, ' '), s => s.phase_ms[p] || 0])},
];
const number = x => !isFinite(x) ? '–' : x === 0 ? '0' :
  Math.abs(x) >= 1e5 || Math.abs(x) < 1e-3 ? x.toExponential(2) : String(+x.toPrecision(4));
let chosen = stats.length - 1;

function colors() {
  const style = getComputedStyle(document.documentElement), of = n => style.getPropertyValue('--' + n).trim();
  return {ink: of('ink'), faint: of('faint'), line: of('line'), series: ['a','b','c','d','e','f','g'].map(of)};
}
// The distance between lines at round numbers, three to eight of them.
function roundStep(range) {
  const power = 10 ** Math.floor(Math.log10(range / 4));
  return power * [1, 2, 5, 10].find(m => range / (m * power) <= 6);
}
function draw(plot) {
  const canvas = plot.canvas, ratio = devicePixelRatio || 1, color = colors();
  const width = canvas.clientWidth, height = canvas.clientHeight;
  canvas.width = width * ratio; canvas.height = height * ratio;
  const pen = canvas.getContext('2d');
  pen.scale(ratio, ratio);
  const left = 58, right = width - 8, top = 8, bottom = height - 20;
  // Where nothing was simulated, as in the first frame, there is nothing to plot.
  const values = plot.series.map(([, f]) => stats.map(s => s.substeps ? f(s) : NaN)), all = values.flat().filter(isFinite);
  const lowest = Math.min(0, ...all), highest = Math.max(...all, lowest + 1e-12);
  const step = roundStep(highest - lowest);
  const least = step * Math.floor(lowest / step), most = step * Math.ceil(highest / step - 1e-9);
  const x = i => left + (right - left) * (stats.length > 1 ? i / (stats.length - 1) : 0.5);
  const y = v => bottom - (bottom - top) * (v - least) / (most - least);
  pen.font = '11px system-ui, sans-serif';
  pen.textBaseline = 'middle';
  for (let k = Math.round(least / step); k <= Math.round(most / step); ++k) {
    const v = k * step;
    pen.strokeStyle = color.line; pen.beginPath(); pen.moveTo(left, y(v)); pen.lineTo(right, y(v)); pen.stroke();
    pen.fillStyle = color.faint; pen.textAlign = 'right'; pen.fillText(number(v), left - 6, y(v));
  }
  pen.textAlign = 'center';
  for (let k = 0; k <= 4 && stats.length; ++k) {
    const i = Math.round((stats.length - 1) * k / 4);
    pen.fillText(stats[i].frame, Math.min(Math.max(x(i), left + 12), right - 12), bottom + 11);
  }
  values.forEach((line, s) => {
    pen.strokeStyle = color.series[s % 7]; pen.lineWidth = 1.5; pen.beginPath();
    line.forEach((v, i) => { if (isFinite(v)) pen.lineTo(x(i), y(v)); });
    pen.stroke();
  });
  if (chosen >= 0) {
    pen.strokeStyle = color.faint; pen.lineWidth = 1;
    pen.beginPath(); pen.moveTo(x(chosen), top); pen.lineTo(x(chosen), bottom); pen.stroke();
  }
  plot.keys.replaceChildren(...plot.series.flatMap(([name], s) => {
    const key = document.createElement('b');
    key.style.color = color.series[s % 7];
    key.textContent = name + ' ';
    return [key, (chosen >= 0 ? number(values[s][chosen]) : '') + ' ' + plot.unit + '   '];
  }));
  plot.choose = event => {
    const share = (event.offsetX - left) / (right - left);
    choose(Math.round(share * (stats.length - 1)));
  };
}
function choose(index) {
  if (!stats.length) return;
  chosen = Math.min(Math.max(index, 0), stats.length - 1);
  const s = stats[chosen];
  if (thumbnails.length) {
    const near = thumbnails.reduce((a, b) => Math.abs(b.frame - s.frame) < Math.abs(a.frame - s.frame) ? b : a);
    document.getElementById('picture').src = 'data:image/png;base64,' + near.png;
  }
  const rows = [['frame', s.frame], ['wall time', number(s.wall_s * 1e3) + ' ms'],
    ['sub-steps', s.substeps + (s.limited_by ? ' (' + s.limited_by + ')' : '')], ['levels', s.levels],
    ['bodies awake', s.bodies_awake], ['contact pairs', s.contact_pairs],
    ['worst overlap', number(100 * s.overlap.worst_ratio) + ' %  ' + s.overlap.bodies.join(' ')],
    ['state hash', s.state_hash]];
  document.getElementById('figures').replaceChildren(...rows.map(row => {
    const line = document.createElement('tr');
    row.forEach(text => { const cell = document.createElement('td'); cell.textContent = text; line.append(cell); });
    return line;
  }));
  plots.forEach(draw);
}
for (const plot of plots) {
  const box = document.createElement('section'), title = document.createElement('h2');
  title.textContent = plot.title + (plot.unit ? ' [' + plot.unit + ']' : '');
  plot.canvas = document.createElement('canvas');
  plot.keys = document.createElement('div');
  plot.keys.className = 'keys';
  plot.canvas.addEventListener('mousemove', event => plot.choose(event));
  box.append(title, plot.canvas, plot.keys);
  document.getElementById('plots').append(box);
}
addEventListener('keydown', event => {
  if (event.key === 'ArrowLeft') choose(chosen - 1);
  if (event.key === 'ArrowRight') choose(chosen + 1);
});
addEventListener('resize', () => plots.forEach(draw));
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => plots.forEach(draw));
choose(chosen);
document.documentElement.dataset.ready = plots.filter(p => p.canvas.width > 0).length;
</script>
</body>
</html>
)html";

/// JSON inside a script element: nothing in it may look like the element's end.
std::string escapedForScript(const std::string& json)
{
    std::string result;
    for (const char letter : json) {
        if (letter == '<')
            result += "\\u003c";
        else
            result += letter;
    }
    return result;
}

std::string facts(const TakeReader& take)
{
    const TakeInfo& info = take.info();
    const std::string frames = std::to_string(take.frames().size()) + " of frames " +
                               std::to_string(info.firstFrame) + "-" +
                               std::to_string(info.lastFrame);
    char rate[64];
    std::snprintf(rate, sizeof rate, "%g", info.framesPerSecond);
    return frames + " · " + rate + " frames per second · " + std::to_string(info.bodies.size()) +
           " bodies · shot " + toHex(info.shotHash) + " · scree " + info.programVersion;
}

/// Each line of stats.jsonl is an object already.
std::string statsJson(const TakeReader& take)
{
    std::string list = "[";
    for (const FrameSummary& frame : take.stats())
        list += (list.size() > 1 ? ",\n" : "\n") + frame.line;
    return list + "\n]";
}

std::string thumbnailsJson(const std::vector<Thumbnail>& thumbnails)
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Thumbnail& thumbnail : thumbnails)
        list.push_back({{"frame", thumbnail.frame}, {"png", base64(thumbnail.png)}});
    return list.dump();
}

/// Puts `text` where {{NAME}} stands, everywhere. What was put in is not looked at again.
std::string filled(const std::string& page,
                   const std::vector<std::pair<std::string, std::string>>& values)
{
    std::string result;
    for (std::size_t at = 0; at < page.size();) {
        const std::size_t begin = page.find("{{", at), end = page.find("}}", begin);
        if (begin == std::string::npos || end == std::string::npos) return result + page.substr(at);
        result += page.substr(at, begin - at);
        const std::string name = page.substr(begin + 2, end - begin - 2);
        const auto value = std::find_if(values.begin(), values.end(),
                                        [&](const auto& entry) { return entry.first == name; });
        result += value == values.end() ? page.substr(begin, end + 2 - begin) : value->second;
        at = end + 2;
    }
    return result;
}

}  // namespace

std::string makeStatsPage(const TakeReader& take, const std::vector<Thumbnail>& thumbnails)
{
    return filled(kPage, {{"TITLE", escapedForHtml(take.info().name)},
                          {"FACTS", escapedForHtml(facts(take))},
                          {"SHOT", escapedForHtml(take.info().resolvedShot)},
                          {"STATS", escapedForScript(statsJson(take))},
                          {"THUMBNAILS", escapedForScript(thumbnailsJson(thumbnails))}});
}

}  // namespace scree
