// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/plan.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <memory>

#include "apps/cli/console.h"
#include "apps/cli/field_options.h"
#include "apps/plan/plan.h"
#include "apps/plan/plan_json.h"
#include "apps/plan/plan_wording.h"
#include "apps/setup/input_files.h"
#include "io/base/format.h"
#include "io/base/printable.h"
#include "io/image/picture_files.h"

namespace petzval::apps {
namespace {

struct PlanOptions {
    RenderOrder order;
    bool json = false;
};

// Commands that render by the plan.
struct Commands {
    std::string samples;               ///< by a number of them
    std::optional<std::string> noise;  ///< by the noise that they bring; absent: none
};

// Command of an order that has the plan's choices in place.
std::string command_of(RenderOrder order, const Plan& plan) {
    order.render.tolerance = kUsualTolerance;  // nothing is left to choose
    order.run.quiet = false;
    order.run.outputs = {"out.exr"};
    for (const io::NamedFile& input : input_files(plan.scene))
        if (io::same_file(input.path, "out.exr")) order.run.outputs = {"picture.exr"};
    return render_command(order);
}

Commands commands_of(RenderOrder order, const Plan& plan) {
    order.render = carried_out(plan, std::move(order.render));
    Commands out{command_of(order, plan), {}};
    // As many digits as percent() shows.
    const double noise = std::strtod(fmt::format("{:.1e}", plan.noise).c_str(), nullptr);
    SampleRequest& samples = order.render.samples;
    if (!(noise > 0) || samples.range) return out;
    samples.count.reset();
    samples.noise = noise;
    out.noise = command_of(std::move(order), plan);
    return out;
}

std::string duration(double s) {
    if (s < 100) return fmt::format("{:.2g} s", s);
    if (s < 6000) return fmt::format("{:.2g} min", s / 60);
    return s < 360000 ? fmt::format("{:.2g} h", s / 3600) : fmt::format("{:.0f} days", s / 86400);
}

void print(const Plan& plan, const Commands& commands) {
    for (const PlanLine& line : lines_of(plan))
        print_line(fmt::format("{:<11} {}: {}", line.choice, line.chosen, line.reason));
    const std::string rare = rare_text(plan);
    const std::string at_least = rare.empty() ? "" : "at least ";
    fmt::print("{:<11} {}: they bring noise from {} to {}{}\n", "samples", plan.samples,
               io::percent(plan.first_noise), at_least, io::percent(plan.noise));
    if (const auto times = times_without_targets(plan))
        fmt::print(
            "{:<11} {} {}: without them about {:.2g} times the samples\n", "targets",
            plan.rare.targeted,
            plan.rare.targeted == 1 ? "lamp that rays are sent to" : "lamps that rays are sent to",
            *times);
    if (!rare.empty()) fmt::print("{:<11} {}\n", "rare light", rare);
    fmt::print("{:<11} {}{}: {} by the model, {}{} by noise\n", "error", at_least,
               io::percent(plan.error()), io::percent(plan.bias), at_least,
               io::percent(plan.noise));
    fmt::print("{:<11} {}: from {} to {} on {} here, {} of CPU time\n", "time",
               duration(plan.wall_s()), duration(Plan::kLeastTime * plan.wall_s()),
               duration(Plan::kMostTime * plan.wall_s()),
               plan.threads == 1 ? "a thread" : fmt::format("{} threads", plan.threads),
               duration(plan.cpu_s));
    fmt::print("{}\n", commands.samples);
    if (commands.noise)
        fmt::print("{:<11} each part of the picture gets as many as it needs for this noise:\n{}\n",
                   "or", *commands.noise);
}

void print_json(const Plan& plan, const Commands& commands) {
    nlohmann::ordered_json out = json_of(plan);
    out["command"] = commands.samples;
    out["command_to_noise"] = commands.noise ? nlohmann::ordered_json(*commands.noise) : nullptr;
    // Names of files need not be UTF-8.
    fmt::print("{}\n", out.dump(2, ' ', true, nlohmann::json::error_handler_t::replace));
}

void plan_command(PlanOptions& o) {
    const RenderOrder& order = o.order;
    check(order.render);
    const int threads = threads_of(order.run);
    flush_denormals();
    integrator::TbbExecutor executor(threads);
    io::limit_picture_threads(threads);
    const RenderRequest& request = order.render;
    const Plan plan =
        make_plan({resolved_scene(request), job_of(request), request.path, request.tolerance},
                  executor, [&](const std::string& text) {
                      if (!order.run.quiet) print_notice(text);
                  });
    const Commands commands = commands_of(order, plan);
    o.json ? print_json(plan, commands) : print(plan, commands);
}

}  // namespace

void add_plan_command(CLI::App& app) {
    auto options = std::make_shared<PlanOptions>();
    CLI::App* command = app.add_subcommand(
        "plan", "print the cheapest way to render a scene within a tolerance, and why");
    add_field_options(*command, options->order, kPlan);
    command->add_flag("--json", options->json, "print it for programs");
    command->callback([options] { plan_command(*options); });
}

}  // namespace petzval::apps
