// SPDX-License-Identifier: Apache-2.0
#include "io/plot/plot.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>

#include "io/base/ascii.h"
#include "io/base/error.h"
#include "io/base/printable.h"
#include "io/file/atomic_file.h"

namespace petzval::io {
namespace {

namespace fs = std::filesystem;

OutputError refusal(const fs::path& path, const std::string& why) {
    return {path.string(), "", "cannot be plotted: " + why};
}

/// gnuplot's terminal for that kind of file.
const char* terminal(const fs::path& path) {
    const std::string ending = lower(path.extension().string());
    if (ending == ".svg") return "svg";
    if (ending == ".png") return "pngcairo";
    throw ArgumentError(path.string(), "", "a plot's name must end in .svg or .png");
}

/// gnuplot string in single quotes, where only these characters mean something.
std::string quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : visible(text)) {
        if (c == '\'') out += '\'';
        out += c;
    }
    return out + "'";
}

const char* style_name(PlotStyle style) {
    switch (style) {
        case PlotStyle::Lines:
        case PlotStyle::Steps:
            return "lines";
        case PlotStyle::Points:
            return "points";
        case PlotStyle::Dots:
            return "points pointtype 7 pointsize 0.3";
        case PlotStyle::LinesAndPoints:
            return "linespoints";
        case PlotStyle::Dashes:
            return "lines dashtype 2";
        case PlotStyle::Cells:
            return "image";
    }
    return "";
}

using Points = std::vector<std::array<double, 2>>;

/// Steps: both ends of the level around each point. gnuplot's own steps leave out the outer halves
/// of the first and the last.
Points steps(const Points& points) {
    Points ends;
    const size_t count = points.size();
    for (size_t i = 0; i < count; ++i) {
        const auto [x, y] = points[i];
        const double before = i > 0 ? x - points[i - 1][0] : count > 1 ? points[1][0] - x : 0;
        const double after = i + 1 < count ? points[i + 1][0] - x : before;
        ends.push_back({x - before / 2, y});
        ends.push_back({x + after / 2, y});
    }
    return ends;
}

/// Rows of numbers as gnuplot reads them, without what cannot be drawn.
std::string rows(const PlotSeries& series, bool logarithmic_x, bool logarithmic_y) {
    const bool is_steps = series.style == PlotStyle::Steps;
    const Points points = is_steps ? steps(series.points) : series.points;
    std::string text;
    for (size_t i = 0; i < points.size(); ++i) {
        const auto [x, y] = points[i];
        if (!std::isfinite(x) || !std::isfinite(y)) continue;
        if ((logarithmic_x && !(x > 0)) || (logarithmic_y && !(y > 0))) continue;
        text += fmt::format("{} {}", x, y);
        if (series.style == PlotStyle::Cells)
            text += std::isfinite(series.values[i]) ? fmt::format(" {}", series.values[i]) : " NaN";
        if (!series.y_bounds.empty()) {
            auto [low, high] = series.y_bounds[i];
            if (logarithmic_y && !(low > 0)) low = y / 10;
            text += fmt::format(" {} {}", low, high);
        }
        text += '\n';
    }
    return text;
}

std::string script(const char* terminal_name, const Plot& plot) {
    std::string text = fmt::format(
        "set encoding utf8\n"
        "set terminal {} size 960,600 noenhanced font 'sans,14' background rgb 'white'\n"
        "set title {}\nset xlabel {}\nset ylabel {}\nset grid\nset offsets 0, 0, graph 0.05, 0\n",
        terminal_name, quoted(plot.title), quoted(plot.x_label), quoted(plot.y_label));
    if (plot.logarithmic) text += "set logscale xy\nset offsets 0, 0, 0, 0\n";
    if (plot.logarithmic_y) text += "set logscale y\nset offsets 0, 0, 0, 0\nset key outside\n";
    constexpr size_t most_in_key = 8;  // more would hide the curves
    if (plot.series.size() > most_in_key) text += "set key outside\n";
    if (plot.equal_scale) text += "set size ratio -1\n";
    if (!plot.value_label.empty())
        text += fmt::format(
            "set offsets 0, 0, 0, 0\nset autoscale fix\nset cblabel {}\nset palette defined (0 "
            "'#440154', 1 '#3b528b', 2 '#21918c', "
            "3 '#5ec962', 4 '#fde725')\n",
            quoted(plot.value_label));
    std::string lines;
    for (size_t i = 0; i < plot.series.size(); ++i) {
        const PlotSeries& series = plot.series[i];
        text += fmt::format("$series{} << end\n{}end\n", i,
                            rows(series, plot.logarithmic, plot.logarithmic || plot.logarithmic_y));
        const bool bars = !series.y_bounds.empty();
        const bool cells = series.style == PlotStyle::Cells;
        lines += fmt::format("{}$series{} using {} with {}{}{} {}", i == 0 ? "plot " : ", ", i,
                             bars    ? "1:2:3:4"
                             : cells ? "1:2:3"
                                     : "1:2",
                             bars ? "yerrorlines" : style_name(series.style),
                             cells ? "" : " linewidth 2", series.grey ? " linecolor 'gray40'" : "",
                             series.label.empty() ? "notitle" : "title " + quoted(series.label));
    }
    return text + lines + "\n";
}

struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closer>;

File temporary_file(const fs::path& path) {
    File file(std::tmpfile());
    if (!file) throw refusal(path, std::strerror(errno));
    return file;
}

std::string read_all(std::FILE* file) {
    std::string text;
    std::array<char, 65536> bytes;
    while (const size_t n = std::fread(bytes.data(), 1, bytes.size(), file))
        text.append(bytes.data(), n);
    return text;
}

/// Last line of gnuplot's complaints, which gives the reason.
std::string last_line(std::string text) {
    text.resize(text.find_last_not_of(" \n") + 1);
    const size_t start = text.find_first_not_of(' ', text.rfind('\n') + 1);
    return start == std::string::npos ? "it says nothing" : text.substr(start);
}

/// Starts gnuplot between two files and a pipe; returns its process.
pid_t start_gnuplot(const fs::path& path, int in, int out, int err) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err, STDERR_FILENO);
    std::string program = "gnuplot", option = "--default-settings";  // no ~/.gnuplot
    const std::array<char*, 3> arguments{program.data(), option.data(), nullptr};
    // Signals as usual, whatever this process blocks or ignores.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t none, usual;
    sigemptyset(&none);
    sigemptyset(&usual);
    for (const int signal : {SIGPIPE, SIGXFSZ}) sigaddset(&usual, signal);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &usual);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    pid_t process = 0;
    const int error =
        ::posix_spawnp(&process, program.c_str(), &actions, &attributes, arguments.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (error == ENOENT)
        throw refusal(path, "gnuplot is not installed; install the package gnuplot-nox");
    if (error != 0) throw refusal(path, std::string("gnuplot: ") + std::strerror(error));
    return process;
}

/// gnuplot's output for a script. The script and its complaints are files, so that neither side
/// waits for the other; the plot is a pipe, as gnuplot ignores a full disk.
std::string run_gnuplot(const fs::path& path, const std::string& text) {
    const File script_file = temporary_file(path), complaints = temporary_file(path);
    if (std::fwrite(text.data(), 1, text.size(), script_file.get()) != text.size() ||
        std::fflush(script_file.get()) != 0)
        throw refusal(path, std::strerror(errno));
    std::rewind(script_file.get());
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw refusal(path, std::strerror(errno));
    const File from_gnuplot(::fdopen(ends[0], "r"));
    File to_us(::fdopen(ends[1], "w"));
    if (!from_gnuplot || !to_us) throw refusal(path, std::strerror(errno));

    const pid_t process =
        start_gnuplot(path, ::fileno(script_file.get()), ends[1], ::fileno(complaints.get()));
    to_us.reset();
    std::string drawn = read_all(from_gnuplot.get());
    int status = 0;
    while (::waitpid(process, &status, 0) < 0)
        if (errno != EINTR) throw refusal(path, std::strerror(errno));
    std::rewind(complaints.get());
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || drawn.empty())
        throw refusal(path, "gnuplot failed: " + last_line(read_all(complaints.get())));
    return drawn;
}

}  // namespace

void check_plot(const fs::path& path) {
    static_cast<void>(terminal(path));
    check_writable(path);
}

void write_plot(const fs::path& path, const Plot& plot) {
    write_file_atomically(path, run_gnuplot(path, script(terminal(path), plot)));
}

}  // namespace petzval::io
