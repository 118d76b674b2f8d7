// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/lens/analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/base/error.h"
#include "io/file/atomic_file.h"
#include "io/file/csv.h"
#include "io/file/rescue.h"

namespace petzval::apps {

double shown(double mm) {
    return std::fabs(mm) < 5e-7 ? 0 : mm;
}

std::string title_of(const camera::Lens& lens, const std::string& what) {
    return fmt::format("{}: {}", lens.prescription().name, what);
}

FieldSetup set_up_lit(const FieldRequest& request, const std::vector<double>& shares) {
    FieldSetup setup = set_up(request, shares);
    require_light(*setup.lens);
    return setup;
}

camera::Section across(const FieldSetup& setup) {
    return setup.section == camera::Section::X ? camera::Section::Y : camera::Section::X;
}

std::vector<camera::BundleRay> traced(const camera::AimedBundle& bundle, double film_mm, int side) {
    return bundle.trace(bundle.grid(side), film_mm);
}

void refuse_dark(const camera::Lens& lens, double field_deg) {
    throw io::ArgumentError(lens.prescription().name, "",
                            "no light of the field {:g}° reaches the film; give a smaller --field",
                            field_deg);
}

std::shared_ptr<AnalysisOptions> add_analysis(CLI::App& lens, const char* name, const char* help,
                                              bool with_fields, const Analysis& analyse,
                                              const char* footer) {
    auto options = std::make_shared<AnalysisOptions>();
    CLI::App* command = lens.add_subcommand(name, help);
    add_field_request(*command, options->field, with_fields);
    command->add_option("-o,--output", options->plot, "plot to write, .svg or .png")->required();
    command->add_option("--csv", options->csv, "the plot's numbers to write too");
    command->footer(footer);
    command->callback([options, analyse] {
        const bool with_csv = !options->csv.empty();
        std::vector<io::NamedFile> outputs{{"-o", options->plot}};
        if (with_csv) outputs.push_back({"--csv", options->csv});
        if (!options->map.empty()) outputs.push_back({"--map", options->map});
        refuse_overwriting(outputs, options->field.request);
        io::check_plot(options->plot);
        if (!options->map.empty()) io::check_plot(options->map);
        if (with_csv) io::check_writable(options->csv);
        const Found found = analyse(*options);
        const auto& all = found.plot.series;
        if (std::all_of(all.begin(), all.end(), [](const auto& s) { return s.points.empty(); }))
            throw io::ArgumentError(options->field.request.lens, "",
                                    "too few rays reach the film for a plot");
        io::attempt_all({[&] {
                             if (with_csv)
                                 io::write_file_atomically(options->csv,
                                                           io::csv_text(found.names, found.rows));
                         },
                         [&] { io::write_plot(options->plot, found.plot); }});
    });
    return options;
}

}  // namespace petzval::apps
