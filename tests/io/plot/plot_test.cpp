// SPDX-License-Identifier: Apache-2.0
#include "io/plot/plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "io/base/error.h"
#include "io/image/picture_files.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temporary_folder.h"

namespace petzval::io {
namespace {

using test::read_bytes;
using test::TemporaryFolder;

Plot plot() {
    return {.title = "a title",
            .x_label = "x (mm)",
            .y_label = "y (mm)",
            .series = {{{{0, 0}, {1, 2}, {2, NAN}, {3, 1}}, PlotStyle::Lines, "first"},
                       {{{0, 3}, {1, 2}, {3, INFINITY}}, PlotStyle::Points, "second"},
                       {{{0.5, 0.5}, {2.5, 1.5}}, PlotStyle::LinesAndPoints, "third"},
                       {{{0, 1}, {1, 1.5}, {2, 0.5}}, PlotStyle::Steps, ""}}};
}
std::string text_of(const std::filesystem::path& path) {
    const auto bytes = read_bytes(path);
    return {bytes.begin(), bytes.end()};
}
std::string complaint(const std::filesystem::path& path, const Plot& p) {
    try {
        write_plot(path, p);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(Plot, IsADrawingWithItsLabels) {
    const TemporaryFolder folder;
    write_plot(folder / "a.svg", plot());
    const std::string svg = text_of(folder / "a.svg");
    for (const char* text : {"a title", "x (mm)", "y (mm)", "first", "second", "third"})
        EXPECT_NE(svg.find(text), std::string::npos) << text;
    EXPECT_TRUE(svg.ends_with("</svg>\n\n")) << svg.substr(svg.size() - 20);
    write_plot(folder / "b.svg", plot());
    EXPECT_EQ(svg, text_of(folder / "b.svg"));
    Plot other = plot();
    other.series[3].style = PlotStyle::Lines;
    write_plot(folder / "b.svg", other);
    EXPECT_NE(svg, text_of(folder / "b.svg"));

    write_plot(folder / "a.PNG", plot());
    const Picture png = read_picture(folder / "a.PNG");
    EXPECT_EQ(png.width, 960);
    EXPECT_EQ(png.height, 600);
    EXPECT_EQ(png.pixels.front(), 1.f) << "white around it";
    EXPECT_EQ(folder.count(), 3u);
}

// A line in x and y that is straight in their logarithms, with what those have no place for.
TEST(Plot, LogarithmicAxesLeaveOutWhatIsNotAbove0) {
    const TemporaryFolder folder;
    Plot p = plot();
    p.logarithmic = true;
    p.series = {{{{0.01, 1e-3}, {0, 1}, {1, 0}, {-1, 1}, {1, 1e-1}}, PlotStyle::Lines, ""}};
    write_plot(folder / "a.svg", p);
    p.series = {{{{0.01, 1e-3}, {1, 1e-1}}, PlotStyle::Lines, ""}};
    write_plot(folder / "b.svg", p);
    EXPECT_EQ(text_of(folder / "a.svg"), text_of(folder / "b.svg"));
    p.series = {{{{0.01, 1e-3}, {0.1, 1e-2}, {1, 1e-1}}, PlotStyle::Lines, ""}};
    write_plot(folder / "b.svg", p);
    EXPECT_NE(text_of(folder / "b.svg").find("0.001"), std::string::npos) << "a tick";
    p.logarithmic = false;
    write_plot(folder / "b.svg", p);
    EXPECT_NE(text_of(folder / "a.svg"), text_of(folder / "b.svg"));
}

TEST(Plot, BarsReachTheirEnds) {
    const TemporaryFolder folder;
    Plot p = plot();
    p.logarithmic = true;
    const auto drawn = [&](double low, double high) {
        p.series = {{{{1, 2}, {10, 3}}, PlotStyle::LinesAndPoints, "m", {{1, 4}, {low, high}}}};
        write_plot(folder / "a.svg", p);
        return text_of(folder / "a.svg");
    };
    EXPECT_EQ(drawn(2, 5), drawn(2, 5));
    EXPECT_NE(drawn(2, 5), drawn(2, 6));
    EXPECT_NE(drawn(2, 5), drawn(2.5, 5));
    EXPECT_EQ(drawn(-1, 5), drawn(0.3, 5)) << "a tenth of the point";
    p.series = {{{{1, 2}, {10, 3}}, PlotStyle::Lines, ""}};
    write_plot(folder / "a.svg", p);
    p.series[0].style = PlotStyle::Dashes;
    write_plot(folder / "b.svg", p);
    EXPECT_NE(text_of(folder / "a.svg"), text_of(folder / "b.svg"));
    p.series[0].grey = true;
    write_plot(folder / "a.svg", p);
    EXPECT_NE(text_of(folder / "a.svg"), text_of(folder / "b.svg"));
}

TEST(Plot, StepsReachHalfOfTheWayAndBeyondTheEnds) {
    const TemporaryFolder folder;
    Plot p = plot();
    p.series = {{{{0, 1}, {1, 2}, {3, 0}}, PlotStyle::Steps, ""}};
    write_plot(folder / "a.svg", p);
    p.series = {{{{-0.5, 1}, {0.5, 1}, {0.5, 2}, {2, 2}, {2, 0}, {4, 0}}, PlotStyle::Lines, ""}};
    write_plot(folder / "b.svg", p);
    EXPECT_EQ(text_of(folder / "a.svg"), text_of(folder / "b.svg"));
}

// What gnuplot or a shell would take for an order.
// The least and the greatest value have the ends of the scale's colours; what is not finite has
// none.
TEST(Plot, CellsHaveTheColoursOfTheirValues) {
    const TemporaryFolder folder;
    Plot p{.title = "cells", .x_label = "x", .y_label = "y", .series = {}, .value_label = "waves"};
    p.series = {{.points = {{0, 0}, {1, 0}, {0, 1}, {1, 1}},
                 .style = PlotStyle::Cells,
                 .values = {-2, NAN, 1, 3}}};
    write_plot(folder / "a.png", p);
    const Picture png = read_picture(folder / "a.png");
    const auto has = [&](float r, float g, float b) {
        int found = 0;
        for (size_t i = 0; i + 2 < png.pixels.size(); i += png.channels.size())
            found += std::fabs(png.pixels[i] - r) < 0.03f &&
                     std::fabs(png.pixels[i + 1] - g) < 0.03f &&
                     std::fabs(png.pixels[i + 2] - b) < 0.03f;
        return found;
    };
    const int cell = 300 * 200;  // of 960 x 600
    EXPECT_GT(has(0x44 / 255.f, 0x01 / 255.f, 0x54 / 255.f), cell);
    EXPECT_GT(has(0xfd / 255.f, 0xe7 / 255.f, 0x25 / 255.f), cell);
    write_plot(folder / "a.svg", p);
    EXPECT_NE(text_of(folder / "a.svg").find("waves"), std::string::npos);
}

TEST(Plot, ShowsTextsLetterByLetter) {
    const TemporaryFolder folder;
    const std::string harm =
        "it's \"q\" `touch " + (folder / "x").string() + "` $(ls) \\n a_b^c {d}";
    Plot p = plot();
    p.title = harm + "\nset output 'x'\t|";
    p.x_label = p.series[0].label = harm;
    write_plot(folder / "a.svg", p);
    const std::string svg = text_of(folder / "a.svg");
    size_t found = 0;
    for (size_t at = 0; (at = svg.find("$(ls) \\n a_b^c {d}", at)) != std::string::npos; ++at)
        ++found;
    EXPECT_EQ(found, 3u);
    EXPECT_NE(svg.find("{d}\\u000aset output 'x'\\u0009|"), std::string::npos);
    EXPECT_EQ(folder.count(), 1u);
}

TEST(Plot, ManyPointsDoNotGetStuck) {
    const TemporaryFolder folder;
    Plot p = plot();
    p.series[0].points.clear();
    for (int i = 0; i < 50000; ++i) p.series[0].points.push_back({double(i), std::sin(double(i))});
    write_plot(folder / "a.svg", p);
    EXPECT_GT(read_bytes(folder / "a.svg").size(), 500000u);
}

TEST(Plot, FailuresSayWhyAndLeaveNothing) {
    const TemporaryFolder folder;
    Plot nothing = plot();
    nothing.series = {{{{0, NAN}}, PlotStyle::Steps, ""}};
    EXPECT_NE(complaint(folder / "a.svg", nothing).find("a.svg: cannot be plotted: gnuplot failed"),
              std::string::npos)
        << complaint(folder / "a.svg", nothing);
    EXPECT_NE(complaint(folder / "a.pdf", plot()).find(".svg or .png"), std::string::npos);
    EXPECT_THROW(check_plot(folder / "a.pdf"), InputError);
    EXPECT_THROW(check_plot(folder / "none" / "a.svg"), InputError);
    EXPECT_NO_THROW(check_plot(folder / "a.svg"));
    EXPECT_NE(complaint("/dev/full", plot()), "");
    {
        const test::FileSizeLimit limit(2000);  // enough for the script, not for the plot
        EXPECT_NE(complaint(folder / "a.svg", plot()).find("cannot be written: File too large"),
                  std::string::npos);
    }
    EXPECT_EQ(folder.count(), 0u);
}

TEST(Plot, NamesThePackageThatIsMissing) {
    const TemporaryFolder folder;
    const std::string path = std::getenv("PATH");
    ::setenv("PATH", folder.path().c_str(), 1);
    const std::string message = complaint(folder / "a.svg", plot());
    ::setenv("PATH", path.c_str(), 1);
    EXPECT_NE(message.find("install the package gnuplot-nox"), std::string::npos) << message;
    EXPECT_EQ(folder.count(), 0u);
}

}  // namespace
}  // namespace petzval::io
