// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/all.h"

#include "apps/cli/command_line.h"
#include "apps/commands/chart.h"
#include "apps/commands/image/image.h"
#include "apps/commands/info.h"
#include "apps/commands/lens/lens.h"
#include "apps/commands/live.h"
#include "apps/commands/merge.h"
#include "apps/commands/plan.h"
#include "apps/commands/render.h"
#include "apps/commands/resume.h"
#include "apps/commands/trace_sample.h"
#include "io/build/build.h"

namespace petzval::apps {

void add_all_commands(CLI::App& app, Session& session) {
    app.name("petzval");
    app.description("A path tracer whose camera is a lens. Every command has --help.");
    app.option_defaults()->take_last();  // of an option that is given twice
    app.set_version_flag("--version", io::program_version() + "\n" + io::build_description());
    app.require_subcommand(1);
    add_render_command(app, session);
    add_resume_command(app, session);
    add_merge_command(app, session);
    add_plan_command(app);
    add_chart_command(app, session);
    add_live_command(app, session);
    add_info_command(app);
    add_trace_sample_command(app, session);
    add_image_commands(app);
    add_lens_commands(app);
    resolve_repeats(app);
    app.footer("petzval help COMMAND prints what a command takes.");
}

}  // namespace petzval::apps
