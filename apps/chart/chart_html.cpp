// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "apps/chart/chart_report.h"
#include "io/base/error.h"
#include "io/base/uri.h"
#include "io/base/xml_text.h"
#include "io/build/build.h"
#include "io/file/read_file.h"
#include "io/image/difference.h"
#include "io/image/symmetric_mse.h"

namespace petzval::apps {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStyle = R"(
body { font: 15px/1.45 sans-serif; max-width: 64em; margin: 2em auto; padding: 0 1em; color: #111 }
h1 { font-size: 1.5em } h2 { font-size: 1.2em; margin-top: 2.5em; border-top: 1px solid #999 }
svg { width: 100%; height: auto; max-width: 46em; display: block }
.pair { display: flex; flex-wrap: wrap; gap: 1em } .pair svg { flex: 1 1 26em; min-width: 0 }
table { border-collapse: collapse; margin: 1em 0 }
th, td { padding: .2em .8em; text-align: right; border-bottom: 1px solid #ccc }
th:first-child, td:first-child { text-align: left }
.doubt { color: #777 }
.pictures { display: flex; flex-wrap: wrap; gap: 1em }
figure { margin: 0; width: 14em } figure img { width: 100%; image-rendering: pixelated }
figcaption { font-size: .85em }
@media print {
  body { font-size: 10pt; margin: 0; max-width: none }
  h2, figure, table, svg { break-inside: avoid } h2 { break-after: avoid }
  svg { max-width: 15cm } figure { width: 5cm }
}
)";

std::vector<uint8_t> bytes_of(const fs::path& path) {
    io::FileBytes file = io::read_file(path);
    if (!file.error.empty()) throw io::InputError(path.string(), "", file.error);
    return std::move(file.bytes);
}

/// SVG from its first element on: what comes before belongs at the head of a file.
std::string drawing(const fs::path& path) {
    const std::vector<uint8_t> bytes = bytes_of(path);
    const std::string text(bytes.begin(), bytes.end());
    return text.substr(std::min(text.find("<svg"), text.size()));
}

std::string figure(const fs::path& path, const std::string& caption) {
    return fmt::format(
        "<figure><img alt=\"\" src=\"data:image/png;base64,{}\">"
        "<figcaption>{}</figcaption></figure>\n",
        io::encode_base64(bytes_of(path)), io::xml_text(caption));
}

std::string with_bounds(const Interval& v) {
    return fmt::format("{:.3g} ± {:.1g}", v.mean, v.high - v.mean);
}

std::string table(const MeasuredCase& of) {
    std::string text =
        "<table><tr><th>method</th><th>samples</th><th>CPU s</th><th>symmetric MSE</th>"
        "<th>relative MSE</th><th>FLIP</th><th>efficiency, 1/s</th><th>95 %</th><th>to the "
        "first</th></tr>\n";
    for (const EfficiencyRow& row : efficiencies(of)) {
        const Interval e = row.point.efficiency();
        text += fmt::format(
            "<tr{}><td>{}</td><td>{}</td><td>{:.3g}</td><td>{}</td><td>{}</td><td>{}</"
            "td><td>{:.3g}</td>"
            "<td>{:.3g} to {:.3g}</td><td>{:.2f}</td></tr>\n",
            row.believed ? "" : " class=\"doubt\"",
            io::xml_text(row.method) + (row.believed ? "" : " (not believed)"), row.point.samples,
            row.point.cpu_s().mean, with_bounds(row.point.symmetric_mse()),
            with_bounds(row.point.relative_mse()), with_bounds(row.point.flip()), e.mean, e.low,
            e.high, row.to_first);
    }
    return text + "</table>\n";
}

std::string pictures(const fs::path& folder, const MeasuredCase& of) {
    std::string text = fmt::format(
        "<p>After about {:.3g} CPU seconds each, and below them their errors (FLIP: black 0, "
        "white 1):</p>\n<div class=\"pictures\">\n",
        of.equal_cpu_s.value_or(0));
    text += figure(folder / reference_picture_name(of), "reference");
    for (const MeasuredMethod& method : of.methods) {
        const ChartPoint& point = method.points[method.shown];
        text += figure(folder / picture_names(of, method).picture,
                       fmt::format("{}: {} samples, {:.3g} s", method.name, point.samples,
                                   point.cpu_s().mean));
    }
    text += "</div>\n<div class=\"pictures\">\n";
    for (const MeasuredMethod& method : of.methods)
        text += figure(
            folder / picture_names(of, method).error,
            fmt::format("{}: FLIP {:.3g}", method.name, method.points[method.shown].flip().mean));
    return text + "</div>\n";
}

std::string section(const ChartReport& report, const MeasuredCase& of) {
    const fs::path& folder = report.subject.folder;
    std::string text =
        fmt::format("<h2>{}: {}</h2>\n<p>", io::xml_text(of.of.name), io::xml_text(of.of.title));
    for (const std::string& sentence : head_of(report, of)) text += io::xml_text(sentence) + " ";
    text += "</p>\n";
    if (of.methods.empty()) return text;
    text += drawing(folder / (of.of.name + ".svg"));
    text += "<div class=\"pair\">\n";
    text += drawing(folder / (of.of.name + "-relative.svg"));
    text += drawing(folder / (of.of.name + "-flip.svg"));
    text += "</div>\n";
    return text + table(of) + pictures(folder, of);
}

}  // namespace

std::string report_html(const ChartReport& report) {
    std::string text = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width\">\n"
        "<title>Speed against accuracy: {0}</title>\n<style>{1}</style></head><body>\n"
        "<h1>Speed against accuracy: {0}</h1>\n"
        "<p>Each line is a method over growing numbers of samples: to the left is quicker, below "
        "is better. Bars are 95 % intervals of confidence of the mean over the seeds (Student's "
        "t). CPU time is that of all threads. The measure of error is the symmetric MSE against "
        "the "
        "reference b, the mean of (a - b)² / ((a² + b²) / 2 + f²), where f is {3:g} times the "
        "reference's mid-grey: 0 to {4:g}, and the same for light that is lost and light that is "
        "added. Efficiency is 1 / (symmetric MSE × CPU time), at the last point that is believed. "
        "The smaller plots show relative MSE, the mean of (a - b)² / (b² + {5:g}), in which light "
        "that is lost costs little and light that is added much, and FLIP (Andersson et al. 2020), "
        "which is what an eye sees at 67 pixels per degree. {2}.</p>\n",
        io::xml_text(report.subject.request.scene.filename().string()), kStyle,
        io::program_version(), io::kSymmetricFloorShare, io::kMostSymmetricMse,
        io::kRelativeMseEpsilon);
    for (const MeasuredCase& of : report.cases) text += section(report, of);
    return text + "</body></html>\n";
}

}  // namespace petzval::apps
