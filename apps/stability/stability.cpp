// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/stability.h"

#include <fmt/format.h>

#include <cctype>
#include <cmath>

#include "apps/stability/sweeps.h"
#include "core/traversal/bvh.h"
#include "io/base/atomic_file.h"
#include "io/base/error.h"
#include "io/base/rescue.h"

namespace petzval {
namespace {

// As GitHub makes the anchor of a heading.
std::string anchor(const std::string& heading) {
    std::string out;
    for (const unsigned char c : heading)
        if (std::isalnum(c) || c == '-')
            out += static_cast<char>(std::tolower(c));
        else if (c == ' ')
            out += '-';
    return out;
}

std::string table_row(const std::vector<std::string>& cells) {
    return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

std::string table_head(const std::vector<std::string>& columns) {
    std::string rule = "|";
    for (size_t i = 0; i < columns.size(); ++i) rule += "---|";
    return table_row(columns) + rule + "\n";
}

std::string section(const Finding& f) {
    std::string out =
        fmt::format("## {}\n{}\n\n{}", f.method, f.sweep, table_head(f.table.columns));
    for (const auto& cells : f.table.rows) out += table_row(cells);
    return out +
           fmt::format("\n- **Fails:** {}. {}\n- **There:** {}\n", f.fails, f.where, f.instead);
}

}  // namespace

std::string stability::number(double a) {
    if (!std::isfinite(a)) return std::isnan(a) ? "NaN" : a > 0 ? "infinity" : "-infinity";
    const double rounded = std::stod(fmt::format("{:.2e}", a));
    const double size = std::fabs(rounded);
    return size == 0 || (size >= 1e-4 && size < 1e5) ? fmt::format("{}", rounded)
                                                     : fmt::format("{:.3g}", rounded);
}

std::string stability::percent(double share) {
    return number(100 * share) + " %";
}

std::vector<Finding> stability_findings() {
    using namespace stability;
    flush_denormals();
    return {third_order_formula(),
            focus_near_focal_length(),
            rejection_of_slivers(),
            degenerate_polygons(),
            choice_by_weight(),
            pupil_at_wide_fields(),
            trace_at_grazing_incidence(),
            trace_over_long_radii(),
            newton_on_strong_aspheres(),
            dispersion_out_of_range(),
            scene_scale(),
            camera_far_from_origin(),
            ggx_energy(),
            ggx_density(),
            tiny_sun(),
            tiny_lamp(),
            defocused_highlights(),
            rays_to_targets(),
            search_for_targets(),
            planned_noise(),
            chains_of_glass(),
            nested_volumes(),
            many_samples(),
            film_sums()};
}

std::string stability_markdown(const std::vector<Finding>& findings) {
    std::string out =
        "# Where methods fail\n\n"
        "    petzval chart --axis stability -o OUT\n\n"
        "This command wrote the page. For each method it sweeps the parameters until the method "
        "fails.\nSeeds are fixed: the same program finds the same on the same machine, and nearly "
        "the "
        "same on another.\nThe command also writes `stability.csv`, with the numbers of all "
        "tables.\n\n" +
        table_head({"method", "what fails", "where"});
    for (const Finding& f : findings)
        out += table_row({fmt::format("[{}](#{})", f.method, anchor(f.method)), f.fails, f.where});
    for (const Finding& f : findings) out += fmt::format("\n{}", section(f));
    return out;
}

std::string stability_csv(const std::vector<Finding>& findings) {
    std::string out = "finding,method,row,quantity,value\n";
    for (const Finding& f : findings)
        for (size_t i = 0; i < f.table.rows.size(); ++i)
            for (size_t k = 0; k < f.table.columns.size(); ++k)
                out += fmt::format("{},{},{},{},{}\n", f.id, f.method, i + 1, f.table.columns[k],
                                   f.table.rows[i][k]);
    return out;
}

std::filesystem::path write_stability(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw OutputError(folder.string(), "", "cannot be made a folder: {}", error.message());
    const std::filesystem::path page = folder / "stability.md";
    check_writable(page);
    const std::vector<Finding> findings = stability_findings();
    attempt_all({[&] { write_file_atomically(folder / "stability.csv", stability_csv(findings)); },
                 [&] { write_file_atomically(page, stability_markdown(findings)); }});
    return page;
}

}  // namespace petzval
