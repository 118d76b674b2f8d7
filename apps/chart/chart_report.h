// SPDX-License-Identifier: Apache-2.0
// The files of a chart: plots, tables, and a page that holds all of it.
#pragma once

#include <string>
#include <vector>

#include "apps/chart/chart_run.h"

namespace petzval::apps {

struct ChartReport {
    ChartSubject subject;  ///< its folder is where the files go
    ChartFrame frame;
    double budget_s = 0;
    int threads = 0;
    std::vector<MeasuredCase> cases;
};

/// Row of the table of efficiencies: the last point of a method that is believed, else its last.
struct EfficiencyRow {
    std::string method;
    ChartPoint point;
    bool believed = false;
    double to_first = 0;  ///< efficiency over that of the first row
};
[[nodiscard]] std::vector<EfficiencyRow> efficiencies(const MeasuredCase&);

/// The sentences at the head of a case: settings, reference, its error, what was chosen or left
/// out.
[[nodiscard]] std::vector<std::string> head_of(const ChartReport&, const MeasuredCase&);

/// Writes the files of a case: NAME.svg and NAME.png over symmetric MSE, NAME-relative.* over
/// relative MSE, NAME-flip.* over FLIP, and each method's picture and map of FLIP in pictures/.
/// Nothing for a case without methods. Each is tried, whichever of them fail. Throws InputError.
void write_case(const ChartReport&, const MeasuredCase&);

/// Writes the table of points.csv, a row for each render, under that name. Throws OutputError.
void write_points(const ChartReport&, const std::filesystem::path& csv);

/// Writes points.csv (a row for each render), points.json and report.html of the cases so far; the
/// plots of write_case() must be there. Throws InputError.
void write_report(const ChartReport&);

/// HTML of report.html, which write_report() writes. Throws InputError where a plot is not there.
[[nodiscard]] std::string report_html(const ChartReport&);

/// Names of a method's pictures in the report's folder.
struct PictureNames {
    std::filesystem::path picture, error;
};
[[nodiscard]] PictureNames picture_names(const MeasuredCase&, const MeasuredMethod&);
[[nodiscard]] std::filesystem::path reference_picture_name(const MeasuredCase&);

}  // namespace petzval::apps
