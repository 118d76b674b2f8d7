// SPDX-License-Identifier: Apache-2.0
// Diagrams, drawn by gnuplot in a process of its own.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace petzval::io {

enum class PlotStyle : uint8_t {
    Lines,
    Points,
    Dots,  ///< small ones, for thousands
    LinesAndPoints,
    Steps,  ///< level around each x, half of the way to its neighbours
    Dashes,
    Cells  ///< of a grid, by colour: `values`
};

struct PlotSeries {
    std::vector<std::array<double, 2>> points{};  ///< x, y; a point that is not finite is left out
    PlotStyle style = PlotStyle::Lines;
    std::string label{};  ///< in the key; none where it is empty
    /// Ends of an error bar in y at each point, drawn with lines and marks; none where it is empty.
    std::vector<std::array<double, 2>> y_bounds{};
    bool grey = false;             ///< a reference for the others
    std::vector<double> values{};  ///< of Cells, one for each point: middles of cells, row by row
};

/// Diagram of at least one series. Texts are shown as they are, letter by letter; UTF-8.
struct Plot {
    std::string title, x_label, y_label;  ///< labels with units
    std::vector<PlotSeries> series;       ///< at least one
    bool equal_scale = false;             ///< a unit of x is as long as one of y
    bool logarithmic = false;    ///< both axes; a point that is not above 0 is left out, and an end
                                 ///< of a bar is drawn at a tenth of its point
    bool logarithmic_y = false;  ///< y alone, likewise; the key stands beside
    std::string value_label{};   ///< what colours of Cells mean, with the unit
};

/// Checks early that a plot can be written. Throws InputError where the name ends in neither .svg
/// nor .png or cannot be written.
void check_plot(const std::filesystem::path&);
/// Writes an SVG or PNG of 960 x 600 pixels, as its name ends. Throws InputError where it cannot be
/// written, gnuplot is not there, or it fails, as with series that hold nothing finite.
void write_plot(const std::filesystem::path&, const Plot&);

}  // namespace petzval::io
