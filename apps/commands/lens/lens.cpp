// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/lens/lens.h"

#include "apps/cli/console.h"
#include "apps/commands/lens/request.h"
#include "apps/setup/input_files.h"
#include "io/glass/agf.h"
#include "io/lens/lens_file.h"

namespace petzval::apps {

void add_lens_request(CLI::App& app, LensRequest& request) {
    app.add_option("lens", request.lens, "name of a lens (see lens list), or .json, .dat, .zmx")
        ->required();
    app.add_option("--glasses", request.catalogs,
                   "catalogue of glasses, .agf, that goes before those that ship; may be given "
                   "more than once")
        ->allow_extra_args(false);
}

void refuse_overwriting(const std::vector<io::NamedFile>& outputs, const LensRequest& request,
                        std::vector<io::NamedFile> inputs) {
    inputs.push_back({"the lens", request.lens});
    for (const std::string& file : request.catalogs)
        inputs.push_back({"the file of --glasses", file});
    for (io::NamedFile& own : own_files()) inputs.push_back(std::move(own));
    io::refuse_overwriting(outputs, inputs);
}

std::shared_ptr<const camera::Lens> open_lens(const LensRequest& request) {
    std::vector<io::AgfCatalog> catalogs;
    for (const std::string& file : request.catalogs) catalogs.emplace_back(file);
    io::LensFile file = io::load_lens(request.lens, catalogs);
    for (const std::string& warning : file.warnings) print_notice(warning);
    return std::make_shared<const camera::Lens>(std::move(file.lens));
}

void add_lens_commands(CLI::App& app) {
    CLI::App* lens = app.add_subcommand("lens", "an optics bench: show, check and trace lenses");
    lens->require_subcommand(1);
    add_lens_table_commands(*lens);
    add_lens_trace_commands(*lens);
    add_lens_analysis_commands(*lens);
    add_lens_wave_commands(*lens);
    add_lens_focus_commands(*lens);
    add_lens_light_commands(*lens);
}

}  // namespace petzval::apps
