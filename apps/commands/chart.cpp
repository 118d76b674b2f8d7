// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/chart.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <system_error>

#include "apps/chart/chart.h"
#include "apps/cli/field_options.h"
#include "apps/cli/readers.h"
#include "apps/commands/session.h"
#include "apps/request/parse.h"
#include "io/image/picture_files.h"

namespace petzval::apps {
namespace {

/// Chart options as given; the texts become values in resolve().
struct ChartOptions {
    ChartRequest request;
    RenderOrder order;
    std::vector<std::string> axes;
    std::string budget = "10m";
};

void add_chart_options(CLI::App& app, ChartOptions& o) {
    ChartRequest& r = o.request;
    o.order.render.scene.size = {192, 108};
    add_field_options(app, o.order, kChart);
    app.add_option("--axis", o.axes,
                   fmt::format("{}", fmt::join(axis_words(), ", ")) +
                       "; default all; may be given more than once")
        ->allow_extra_args(false);
    app.add_option("-o,--output", r.subject.folder, "folder of the report; made if need be")
        ->required();
    app.add_option("--budget", o.budget, "time for all of it: 60s, 10m (default), 1h30m");
    app.add_option("--reference", r.reference,
                   "EXR of the same frame, in place of references that are rendered");
    app.add_option("--seeds", r.frame.seeds, "renders of each method (default 5)")
        ->transform(whole_number_between(kChartSeeds, kMostChartSeeds));
    app.add_option("--exposure", r.frame.exposure_ev, "stops, of pictures and of FLIP")
        ->transform(number_between(-100, 100, kStops));
}

void resolve(ChartOptions& o) {
    ChartRequest& r = o.request;
    r.axes = parse_axes("--axis", o.axes);
    r.budget_s = parse_duration_s("--budget", o.budget);
    r = chart_of(std::move(r), o.order.render, "--output");
}

void print_case(const MeasuredCase& of) {
    print_line(of.of.name + ": " + of.of.title);
    for (const std::string& remark : of.of.remarks) print_line("  " + remark);
    if (of.reference.symmetric_mse)
        fmt::print("  reference: {}, {} x {} samples, symmetric MSE {:.2g}\n", of.of.reference.name,
                   of.reference.parts, of.reference.samples, *of.reference.symmetric_mse);
    for (const EfficiencyRow& row : efficiencies(of))
        fmt::print(
            "  {:<20} {:>6} samples {:>8.3g} CPU s  symmetric MSE {:<8.3g} FLIP {:<6.3g} "
            "efficiency {:.3g}/s{}\n",
            row.method, row.point.samples, row.point.cpu_s().mean, row.point.symmetric_mse().mean,
            row.point.flip().mean, row.point.efficiency().mean,
            row.believed ? "" : " (not believed)");
    std::fflush(stdout);
}

int chart_command(ChartOptions& o, Interrupt& interrupt) {
    resolve(o);
    flush_denormals();
    const int threads = threads_of(o.order.run);
    integrator::TbbExecutor executor(threads);
    io::limit_picture_threads(threads);
    const auto notice = [quiet = o.order.run.quiet](const std::string& text) {
        if (!quiet) print_notice(text);
    };
    io::load_image_codec();  // before minutes of work: pictures will be written
    interrupt.arm();
    const auto finished = [&](const MeasuredCase& of) {
        if (o.order.run.quiet) return;
        try {
            print_case(of);
        } catch (const std::system_error&) {  // the report matters more than what is printed
        }
    };
    const ChartOutcome outcome =
        run_chart(o.request, executor, interrupt.monitor(), notice, finished, ChartClock());
    const std::string page = (o.request.subject.folder / "report.html").string();
    if (outcome.stopped) {
        notice(outcome.measured > 0
                   ? fmt::format("stopped: what was measured whole is in {}", page)
                   : "stopped: nothing was measured whole, and no report is written");
        return kStopped;
    }
    if (!o.order.run.quiet) print_line(page);
    return 0;
}

}  // namespace

void add_chart_command(CLI::App& app, Session& session) {
    auto options = std::make_shared<ChartOptions>();
    CLI::App* command = app.add_subcommand(
        "chart", "measure ways to render a scene: time against error, as a report");
    add_chart_options(*command, *options);
    command->callback(
        [options, &session] { session.exit_code = chart_command(*options, session.interrupt); });
}

}  // namespace petzval::apps
