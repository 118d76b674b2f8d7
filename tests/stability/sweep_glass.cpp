// SPDX-License-Identifier: Apache-2.0
// Dispersion formulas outside of the wavelengths that they were fitted to.
#include <fmt/format.h>

#include "core/spectrum/spectrum_table.h"
#include "io/glass/agf.h"
#include "io/glass/catalogue.h"
#include "tests/stability/sweeps.h"

namespace petzval::stability {
namespace {

constexpr double kFirst_sweep_nm = 200, kLast_sweep_nm = 3000;

// What is wrong with a formula between two wavelengths, at the first that is wrong.
struct Faults {
    bool no_number = false, below_one = false, jumps = false, rises = false;

    [[nodiscard]] bool breaks() const { return no_number || below_one || jumps; }
};

Faults faults_of(const Glass& glass, double first_nm, double last_nm) {
    Faults out;
    double before = glass.index(first_nm);
    for (double nm = first_nm; nm <= last_nm; ++nm) {
        const double n = glass.index(nm);
        out.no_number |= !std::isfinite(n);
        out.below_one |= n < 1;
        out.jumps |= std::fabs(n - before) > 0.05;
        out.rises |= n > before + 1e-12;
        before = n;
    }
    return out;
}

Glass without_range(Glass glass) {
    glass.first_nm = 0;
    glass.last_nm = 1e9;
    return glass;
}

const char* name_of(const Glass& glass) {
    return std::holds_alternative<Sellmeier>(glass.formula)     ? "Sellmeier"
           : std::holds_alternative<PowerSeries>(glass.formula) ? "power series"
                                                                : "other";
}

}  // namespace

Finding dispersion_out_of_range() {
    Finding f{.method = "Dispersion formulas out of their range", .fails = "NaN, bias"};
    f.sweep = fmt::format(
        "All glasses of assets/glass at every nm from {:g} to {:g}: the formula by itself, beyond "
        "the range that it was fitted to, and as it is used. Glasses whose index is not a number, "
        "is below 1, or jumps by more than 0.05 in a nm.",
        kFirst_sweep_nm, kLast_sweep_nm);
    f.table.columns = {
        "formula", "glasses",           "not a number",      "below 1",
        "jumps",   "breaks below (nm)", "breaks above (nm)", "as used: any of these"};
    const std::vector<Glass> catalogue = io::glass_catalog();
    double blue_nm = 0, red_nm = HUGE_VAL;
    size_t broken = 0, broken_as_used = 0;
    std::string used_name;
    for (const std::string kind : {"Sellmeier", "power series"}) {
        size_t count = 0, no_number = 0, below_one = 0, jumps = 0, used = 0;
        double blue_here = 0, red_here = HUGE_VAL;
        for (const Glass& glass : catalogue) {
            if (name_of(glass) != kind) continue;
            ++count;
            const Glass bare = without_range(glass);
            const Faults faults = faults_of(bare, kFirst_sweep_nm, kLast_sweep_nm);
            no_number += faults.no_number;
            below_one += faults.below_one;
            jumps += faults.jumps;
            if (faults_of(glass, kFirst_sweep_nm, kLast_sweep_nm).breaks())
                ++used, used_name = glass.name;
            broken += faults.breaks();
            if (!faults.breaks()) continue;
            for (double nm = kLineD_nm; nm >= kFirst_sweep_nm; --nm)
                if (faults_of(bare, nm, nm + 1).breaks()) {
                    blue_here = std::fmax(blue_here, nm);
                    break;
                }
            for (double nm = kLineD_nm; nm <= kLast_sweep_nm; ++nm)
                if (faults_of(bare, nm, nm + 1).breaks()) {
                    red_here = std::fmin(red_here, nm);
                    break;
                }
        }
        add_row(f, kind, count, no_number, below_one, jumps,
                blue_here > 0 ? number(blue_here) : "none",
                std::isfinite(red_here) ? number(red_here) : "none", used);

        blue_nm = std::fmax(blue_nm, blue_here), red_nm = std::fmin(red_nm, red_here);
        broken_as_used += used;
    }
    // What holding the end of a range costs where paths carry light.
    size_t held = 0;
    double most_held = 0;
    std::string held_name;
    for (const Glass& glass : catalogue) {
        double off = 0;
        for (int nm = kFirst_nm; nm <= kLast_nm; ++nm)
            off = std::fmax(
                off, std::fabs(glass.index(double(nm)) - without_range(glass).index(double(nm))));
        held += off > 0;
        if (off > most_held) most_held = off, held_name = glass.name;
    }
    f.where = fmt::format(
        "{} of {} formulas break somewhere, in the blue up to {} nm, in the red {}; as used, {}{}. "
        "From {} to {} nm, {} glasses are out of their range somewhere: the index that is held is "
        "up to {} off the formula ({})",
        broken, catalogue.size(), number(blue_nm),
        std::isfinite(red_nm) ? "from " + number(red_nm) + " nm on" : std::string("nowhere"),
        broken_as_used, used_name.empty() ? "" : " (" + used_name + ")", kFirst_nm, kLast_nm, held,
        number(most_held), held_name);
    const std::string pole = "CC bad\nNM POLE 2 0 1.5 50\nCD 1.0 0.25 0 0 0 0\nLD 0.2 3.0\n";
    f.instead = fmt::format(
        "Out of its range a glass keeps the index of the range's end. A catalogue whose formula "
        "breaks between 360 and 830 nm is refused: \"{}\".",
        refusal_of([&] { static_cast<void>(io::AgfCatalog(pole, "maker.agf").find("POLE")); }));
    return f;
}

}  // namespace petzval::stability
