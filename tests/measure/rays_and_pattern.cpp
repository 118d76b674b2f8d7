// SPDX-License-Identifier: Apache-2.0
// How wrong the contrast is of pictures made of rays and of the pattern of a pupil without
// aberrations: the tables of docs/measured/waves.md. For every lens that ships, wide open and
// stopped down, on the axis, at 0.7 of its half field and at its edge; a distant object. The first
// table takes the lines F, d and C together, the second each by itself.
//
//   rays_and_pattern paraxial|traced [CYCLES]     how lenses are focused; up to CYCLES per mm
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <string_view>

#include "camera/bench/analysis.h"
#include "camera/bench/spectral_lines.h"
#include "camera/lens/focus.h"
#include "camera/setup/lens_bench.h"
#include "camera/waves/rays_and_pattern.h"
#include "io/lens/lens_file.h"

namespace petzval {
namespace {

constexpr double kStops[] = {0, 4, 8, 16, 22};  // 0: wide open
constexpr double kShares[] = {0, 0.7, 1};       // of the half field
constexpr double kRms[] = {0, 0.01, 0.02, 0.035, 0.05, 0.07, 0.1, 0.15, 0.25, 0.5, 1, 2, INFINITY};

std::optional<camera::LensBench> set_up(const camera::Lens& whole, double fnumber,
                                        camera::FocusBy by) {
    if (fnumber == 0) return camera::LensBench::focused(whole, INFINITY, by);
    const auto stopped = camera::stopped_down(whole, fnumber);
    return stopped ? camera::LensBench::focused(camera::Lens(*stopped), INFINITY, by)
                   : std::nullopt;
}

struct Row {
    std::string text;
    double worst = 0;
};

// What the program measures.
struct Measured {
    double most_cycles_per_mm;
    std::vector<Row> rows{};
    std::vector<camera::RaysAndPattern> waves{};  // line by line
    double slowest_s = 0;

    [[nodiscard]] std::optional<camera::RaysAndPattern> at_field(
        const camera::LensBench& bench, double field_deg,
        std::span<const camera::WeighedWavelength> light) const {
        const auto found = camera::diffraction_limits(*bench.lens, bench.film_mm, bench.distance_mm,
                                                      {&field_deg, 1}, light, most_cycles_per_mm);
        return found ? std::optional(found->worst) : std::nullopt;
    }
    // Cell of a stop: the three fields.
    void add(Row& row, const camera::LensBench& bench, double half_deg) {
        std::vector<camera::WeighedWavelength> light;
        for (const camera::SpectralLine& line : camera::kSpectralLines)
            light.push_back({line.nm, 1. / 3});
        const std::clock_t before = std::clock();
        for (const double share : kShares) {
            const auto found = at_field(bench, share * half_deg, light);
            if (!found) {
                row.text += " –";
                continue;
            }
            row.text += fmt::format(fmt::runtime(found->sharp_or_wide ? " {:.2f}" : " *{:.2f}*"),
                                    found->contrast_error);
            row.worst = std::max(row.worst, found->contrast_error);
        }
        slowest_s = std::max(slowest_s, double(std::clock() - before) / CLOCKS_PER_SEC);
        for (const double share : kShares)
            for (const camera::SpectralLine& line : camera::kSpectralLines) {
                const camera::WeighedWavelength one{line.nm, 1};
                if (const auto found = at_field(bench, share * half_deg, {&one, 1}))
                    waves.push_back(*found);
            }
    }
};

void print_lenses(std::vector<Row> rows) {
    std::stable_sort(rows.begin(), rows.end(),
                     [](const Row& a, const Row& b) { return a.worst > b.worst; });
    fmt::print("| lens | wide open | f/4 | f/8 | f/16 | f/22 |\n|---|---|---|---|---|---|\n");
    for (const Row& row : rows) fmt::print("{}\n", row.text);
}

// Median and nine tenths of a figure.
std::string spread_of(const std::vector<const camera::RaysAndPattern*>& all,
                      double camera::RaysAndPattern::*figure) {
    std::vector<double> values;
    for (const camera::RaysAndPattern* one : all) values.push_back(one->*figure);
    std::sort(values.begin(), values.end());
    return fmt::format("{:.3f}, {:.3f}, {:.3f}", values[values.size() / 2],
                       values[values.size() * 9 / 10], values.back());
}

void print_by_rms(const std::vector<camera::RaysAndPattern>& waves) {
    fmt::print(
        "\n| RMS (λ) | waves | blur (λ N) | rays and pattern | pattern alone | rays alone |\n"
        "|---|---|---|---|---|---|\n");
    for (size_t i = 0; i + 1 < std::size(kRms); ++i) {
        std::vector<const camera::RaysAndPattern*> here;
        for (const camera::RaysAndPattern& wave : waves)
            if (wave.rms_waves >= kRms[i] && wave.rms_waves < kRms[i + 1]) here.push_back(&wave);
        if (here.empty()) continue;
        std::vector<double> blurs;
        for (const camera::RaysAndPattern* wave : here) blurs.push_back(wave->blur);
        std::nth_element(blurs.begin(), blurs.begin() + std::ptrdiff_t(blurs.size() / 2),
                         blurs.end());
        const std::string range = std::isinf(kRms[i + 1])
                                      ? fmt::format("above {:g}", kRms[i])
                                      : fmt::format("{:g} to {:g}", kRms[i], kRms[i + 1]);
        const double blur = blurs[blurs.size() / 2];
        fmt::print("| {} | {} | {} | {} | {} | {} |\n", range, here.size(),
                   blur < 100 ? fmt::format("{:.2g}", blur) : fmt::format("{:.0f}", blur),
                   spread_of(here, &camera::RaysAndPattern::contrast_error),
                   spread_of(here, &camera::RaysAndPattern::error_of_pattern),
                   spread_of(here, &camera::RaysAndPattern::error_of_rays));
    }
}

void print_rule(const std::vector<camera::RaysAndPattern>& waves) {
    const auto count = [&](auto which) {
        std::vector<const camera::RaysAndPattern*> here;
        int blurred = 0;
        for (const camera::RaysAndPattern& wave : waves)
            if (which(wave)) {
                here.push_back(&wave);
                blurred += wave.by_rays_and_pattern < wave.by_waves;
            }
        if (here.empty()) return std::string("none");
        return fmt::format("{} waves: median, 9 of 10, largest error {}; too blurred in {}",
                           here.size(), spread_of(here, &camera::RaysAndPattern::contrast_error),
                           blurred);
    };
    fmt::print("\nRMS < 0.1: {}\n", count([](const auto& w) { return w.rms_waves < 0.1; }));
    fmt::print("blur > 4:  {}\n", count([](const auto& w) { return w.blur > 4; }));
    fmt::print("neither:   {}\n", count([](const auto& w) { return !w.sharp_or_wide; }));
    for (const double wide : {8., 12., 20., 40., 100.})
        fmt::print("blur > {}: {}\n", wide, count([&](const auto& w) { return w.blur > wide; }));
}

int main_of(int count, char** words) {
    const std::string_view by = count > 1 ? words[1] : "";
    Measured measured{.most_cycles_per_mm = count > 2 ? std::atof(words[2]) : 100};
    if ((by != "paraxial" && by != "traced") || !(measured.most_cycles_per_mm > 0)) {
        fmt::print(stderr, "rays_and_pattern paraxial|traced [CYCLES]\n");
        return 2;
    }
    for (const io::LensSummary& lens : io::list_lenses()) {
        const camera::Lens whole(io::load_lens(lens.name).lens);
        const auto half_deg = camera::field_half_deg(whole.prescription());
        if (!half_deg) continue;
        Row row{fmt::format("| `{}` |", lens.name)};
        for (const double fnumber : kStops) {
            const auto bench =
                set_up(whole, fnumber,
                       by == "traced" ? camera::FocusBy::Traced : camera::FocusBy::Paraxial);
            if (bench) measured.add(row, *bench, *half_deg);
            row.text += " |";
        }
        measured.rows.push_back(std::move(row));
    }
    print_lenses(measured.rows);
    print_by_rms(measured.waves);
    print_rule(measured.waves);
    fmt::print("three fields of three wavelengths: {:.2f} s of CPU time at most\n",
               measured.slowest_s);
    return 0;
}

}  // namespace
}  // namespace petzval

int main(int count, char** words) {
    return petzval::main_of(count, words);
}
