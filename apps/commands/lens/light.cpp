// SPDX-License-Identifier: Apache-2.0
// petzval lens transmittance, budget, ghosts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/cli/console.h"
#include "apps/commands/lens/field.h"
#include "camera/bench/light_budget.h"
#include "io/base/error.h"
#include "io/file/atomic_file.h"
#include "io/file/csv.h"
#include "io/file/rescue.h"
#include "io/lens/coat_file.h"
#include "io/lens/lens_drawing.h"
#include "io/plot/plot.h"

namespace petzval::apps {
namespace {

struct LightOptions {
    FieldRequest field;
    std::string coating = "filed", out, csv;
};

/// A lens with its coats.
struct CoatedLens {
    FieldSetup setup;
    camera::Coating coating;
    [[nodiscard]] const camera::Lens& lens() const { return *setup.lens; }
    [[nodiscard]] camera::LensCoats coats() const { return {lens(), coating}; }
    [[nodiscard]] camera::DistantLight light(double field_deg, double nm) const {
        return {field_deg, setup.section, nm, setup.film_mm, camera::lit_radius_mm(lens())};
    }
};

CoatedLens set_up_coated(const LightOptions& o, const std::vector<double>& shares) {
    CoatedLens out{set_up(o.field, shares), camera::Coating::Filed};
    require_light(out.lens());
    const camera::SurfaceCoat coat = io::read_coat(o.coating);
    if (const auto* name = std::get_if<camera::Coating>(&coat)) {
        out.coating = *name;
        if (out.coating == camera::Coating::Year && out.lens().prescription().year == 0)
            throw io::ArgumentError(o.field.request.lens, "",
                                    "its file states no year, by which --coating year goes: give "
                                    "--coating filed, or another");
    } else {
        camera::Prescription file = out.lens().prescription();
        for (size_t i = 0; i < file.surfaces.size(); ++i)
            file.surfaces[i].coat = camera::touches_air(out.lens().surfaces<double>()[i])
                                        ? coat
                                        : camera::SurfaceCoat(camera::Coating::Uncoated);
        out.setup.lens = std::make_shared<const camera::Lens>(std::move(file));
    }
    return out;
}

// Prints a table below what it is of.
void print_table(const LightOptions& o, const camera::Lens& lens, const std::string& table) {
    print_line(fmt::format("{}, coating {}", lens.prescription().name, o.coating));
    size_t clear = 0;
    for (const Glass& glass : lens.media()) clear += glass.absorption_per_mm.empty();
    if (--clear > 0)  // air
        fmt::print("no absorption is known of {} of {} glasses: they count as clear\n", clear,
                   lens.media().size() - 1);
    fmt::print("{}\n", table);
}

[[noreturn]] void refuse_dark_field(const LightOptions& o, double field_deg) {
    throw io::ArgumentError(o.field.request.lens, "",
                            "no light of the field {:g}° reaches the film; give a smaller --field",
                            field_deg);
}

void transmittance_command(const LightOptions& o) {
    const CoatedLens lens = set_up_coated(o, {0, 0.7, 1});
    const camera::LensCoats coats = lens.coats();
    std::string table = fmt::format("{:>8}", "nm");
    for (const double deg : lens.setup.fields_deg)
        table += fmt::format(" {:>9}", fmt::format("{:.4g}°", deg));
    for (int nm = 400; nm <= 700; nm += 20) {
        table += fmt::format("\n{:>8}", nm);
        for (const double deg : lens.setup.fields_deg) {
            const auto share = camera::transmittance(lens.lens(), coats, aim(lens.setup, deg, nm),
                                                     lens.setup.film_mm);
            if (!share) refuse_dark_field(o, deg);
            table += fmt::format(" {:>9.5f}", *share);
        }
    }
    print_table(o, lens.lens(), table);
}

// Shares of the light that meets the first surface, in per cent, at one field.
camera::LightBudget budget_of(const LightOptions& o, const CoatedLens& lens,
                              const camera::LensCoats& coats, double deg, double nm) {
    const auto found = camera::light_budget(lens.lens(), coats, lens.light(deg, nm));
    if (!found) refuse_dark_field(o, deg);
    return *found;
}

io::Plot budget_plot(const LightOptions& o, const CoatedLens& lens,
                     const camera::LensCoats& coats) {
    constexpr int steps = 10;
    constexpr double nm = 550, least = 1e-5;
    io::Plot plot{.title = fmt::format("{}, coating {}, {} nm", lens.lens().prescription().name,
                                       o.coating, nm),
                  .x_label = "field (degrees)",
                  .y_label = "share of the light on the first surface (%)",
                  .series = {},
                  .logarithmic_y = true};
    for (const auto& [name, part] : camera::kBudgetParts)
        plot.series.push_back({{}, io::PlotStyle::LinesAndPoints, name});
    const double most_deg = lens.setup.fields_deg.back();
    for (int i = 0; i <= steps; ++i) {
        const double deg = most_deg * i / steps;
        const camera::LightBudget b = budget_of(o, lens, coats, deg, nm);
        for (size_t k = 0; k < camera::kBudgetParts.size(); ++k)
            if (const double share = b.*camera::kBudgetParts[k].second; share > least)
                plot.series[k].points.push_back({deg, 100 * share});
    }
    return plot;
}

void budget_command(const LightOptions& o) {
    std::vector<io::NamedFile> outputs;
    if (!o.out.empty()) outputs.push_back({"-o", o.out}), io::check_plot(o.out);
    if (!o.csv.empty()) outputs.push_back({"--csv", o.csv}), io::check_writable(o.csv);
    refuse_overwriting(outputs, o.field.request, {{"the file of --coating", o.coating}});
    const CoatedLens lens = set_up_coated(o, {0, 0.7, 1});
    const camera::LensCoats coats = lens.coats();
    std::vector<std::string> names{"field_deg", "nm"};
    std::vector<std::vector<double>> rows;
    std::string table = fmt::format("{:>9} {:>6}", "field (°)", "nm");
    for (const auto& [name, part] : camera::kBudgetParts) {
        table += fmt::format(" {:>13}", name);
        names.emplace_back(name);
    }
    table += fmt::format(" {:>9}", "sum (%)");
    for (const double deg : lens.setup.fields_deg)
        for (const double nm : {450., 550., 650.}) {
            const camera::LightBudget b = budget_of(o, lens, coats, deg, nm);
            rows.push_back({deg, nm});
            table += fmt::format("\n{:>9.4g} {:>6}", deg, nm);
            for (const auto& [name, part] : camera::kBudgetParts) {
                table += fmt::format(" {:>13.4f}", 100 * (b.*part));
                rows.back().push_back(b.*part);
            }
            table += fmt::format(" {:>9.3f}", 100 * b.sum());
        }
    print_table(o, lens.lens(), table);
    io::attempt_all({[&] {
                         if (!o.csv.empty())
                             io::write_file_atomically(o.csv, io::csv_text(names, rows));
                     },
                     [&] {
                         if (!o.out.empty()) io::write_plot(o.out, budget_plot(o, lens, coats));
                     }});
}

void draw_ghost(const LightOptions& o, const CoatedLens& lens, const camera::LensCoats& coats,
                double deg, const camera::Ghost& ghost) {
    constexpr int rays = 9;
    io::LensDrawing drawing{.section = lens.setup.section,
                            .film_mm = lens.setup.film_mm,
                            .film_radius_mm = lens.lens().prescription().image_circle_mm / 2,
                            .rays = {},
                            .caption = {}};
    drawing.caption =
        fmt::format("{}, coating {}: light from {:.4g}° that surfaces {} and {} reflect, line d",
                    lens.lens().prescription().name, o.coating, deg, ghost.first, ghost.second);
    for (camera::Outline& path :
         camera::ghost_paths(lens.lens(), coats, lens.light(deg, kLineD_nm), ghost, rays))
        drawing.rays.push_back({std::move(path), "#c02020"});
    io::write_drawing(o.out, lens.lens(), drawing);
}

void ghosts_command(const LightOptions& o) {
    constexpr size_t most_printed = 10;
    std::vector<io::NamedFile> outputs;
    if (!o.out.empty()) outputs.push_back({"-o", o.out}), io::check_drawing(o.out);
    refuse_overwriting(outputs, o.field.request, {{"the file of --coating", o.coating}});
    const CoatedLens lens = set_up_coated(o, {0, 0.7});
    const camera::LensCoats coats = lens.coats();
    std::string table;
    std::vector<camera::Ghost> all;
    std::optional<camera::Ghost> worst;
    double worst_deg = 0;
    for (const double deg : lens.setup.fields_deg) {
        const auto found = camera::ghosts(lens.lens(), coats, lens.light(deg, kLineD_nm));
        table += fmt::format(
            "\nghosts of a distant point at {:.4g}°, line d; the image has light 1\n"
            "{:>9} {:>14} {:>12} {:>12} {:>12}\n",
            deg, "surfaces", "brightness/mm2", "light", "radius (mm)", "focus (mm)");
        for (size_t i = 0; i < std::min(most_printed, found.size()); ++i)
            table += fmt::format("{:>9} {:>14.3e} {:>12.3e} {:>12.4f} {:>12.3f}\n",
                                 fmt::format("{}, {}", found[i].first, found[i].second),
                                 found[i].per_mm2, found[i].light, found[i].radius_mm,
                                 found[i].focus_mm);
        if (found.empty()) table += fmt::format("{:>9}\n", "none");
        if (!found.empty() && (!worst || found[0].per_mm2 > worst->per_mm2))
            worst = found[0], worst_deg = deg;
        all.insert(all.end(), found.begin(), found.end());
    }
    if (const auto surface = camera::worst_surface(all))
        table += fmt::format(
            "\nA better coating of surface {} would help most: {:.0f} % of all ghosts' "
            "light is reflected there.\n",
            surface->first, 100 * surface->second);
    if (const auto glare = camera::veiling_glare(lens.lens(), coats, lens.setup.film_mm))
        table +=
            fmt::format("veiling glare of a black hole in a white field: {:.3f} %", 100 * *glare);
    if (!o.out.empty() && !worst)
        throw io::ArgumentError(o.field.request.lens, "", "has no ghost that could be drawn");
    print_table(o, lens.lens(), table);
    if (!o.out.empty()) draw_ghost(o, lens, coats, worst_deg, *worst);
}

std::shared_ptr<LightOptions> add_light_command(CLI::App& lens, const char* name, const char* help,
                                                void (*command)(const LightOptions&),
                                                const char* footer) {
    auto options = std::make_shared<LightOptions>();
    CLI::App* app = lens.add_subcommand(name, help);
    add_lens_request(*app, options->field.request);
    app->add_option("--field", options->field.fields,
                    "angles from the axis in degrees, as 0,10,14 (default: parts of the lens's "
                    "half field)");
    app->add_option("--coating", options->coating,
                    fmt::format("{}, or a file of layers (.json) for all surfaces that touch air "
                                "(default: filed, as the lens's file says)",
                                io::coating_names()));
    app->callback([options, command] { command(*options); });
    app->footer(footer);
    return options;
}

}  // namespace

void add_lens_light_commands(CLI::App& lens) {
    add_light_command(lens, "transmittance", "light that surfaces and glass let through",
                      transmittance_command,
                      "By wavelength and field, of a distant point's light that no rim stops.");
    const auto budget = add_light_command(
        lens, "budget", "where the light goes that meets the first surface", budget_command,
        "By field and wavelength, of a distant point's light, in per cent. Rims, iris and barrel "
        "are black, and so is the film.");
    CLI::App* app = lens.get_subcommand("budget");
    app->add_option("-o,--output", budget->out, "plot over the field to write, .svg or .png");
    app->add_option("--csv", budget->csv, "the table's numbers to write, as shares of 1");
    const auto ghosts = add_light_command(
        lens, "ghosts", "pairs of surfaces whose reflections reach the film, the brightest first",
        ghosts_command,
        "Brightness: light over the area of an even disc of the same root mean square radius. "
        "Focus: how far behind the film the ghost is smallest. The veiling glare is what ISO 9358 "
        "measures, without film and barrel.");
    lens.get_subcommand("ghosts")->add_option("-o,--output", ghosts->out,
                                              "drawing of the brightest to write, .svg");
}

}  // namespace petzval::apps
