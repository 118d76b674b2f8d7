// SPDX-License-Identifier: Apache-2.0
#include "camera/lens/lens_coats.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace petzval::camera {
namespace {

// Cells of the coarsest table, of 10 nm, and how many times finer one may be each way.
constexpr int kWaves = (kLast_nm - kFirst_nm) / 10, kCosines = 128, kMostFiner = 4;

double wave_nm(double cell, int waves) {
    return kFirst_nm + cell * (kLast_nm - kFirst_nm) / waves;
}

Coating named(Coating coating, const Lens& lens) {
    return coating == Coating::Year ? usual_in(lens.prescription().year) : coating;
}

}  // namespace

LensCoats::LensCoats(const Lens& lens, Coating asked) : coats_(size_t(lens.size())) {
    const Coating coating = named(asked, lens);
    for (size_t i = 0; i < coats_.size(); ++i) {
        const auto& s = lens.surfaces<double>()[i];
        const SurfaceCoat& filed = lens.prescription().surfaces[i].coat;
        const SurfaceCoat of = coating == Coating::Filed ? filed : coating;
        const auto* const layers = std::get_if<LayerStack>(&of);
        const auto* const name = std::get_if<Coating>(&of);
        Coat& coat = coats_[i];
        coat.ideal = s.medium_before == s.medium_after || (name && *name == Coating::Ideal);
        coat.air_behind = s.medium_after == 0;
        if (coat.ideal) continue;
        if (layers)
            coat.layers = *layers;
        else if (touches_air(s))
            coat.layers = layers_of(
                *name,
                lens.media()[std::max(s.medium_before, s.medium_after)].index(kQuarterWave_nm));
    }
}

SurfaceShares LensCoats::at(int surface, Towards towards, const Incidence& light) const {
    const Coat& coat = coats_[size_t(surface)];
    if (coat.ideal) return {};
    return surface_shares(coat.layers, coat.air_behind == (towards == Towards::Film), light);
}

CoatTables::CoatTables(const Lens& lens, Coating coating)
    : lens_(&lens),
      coating_(named(coating, lens)),
      coats_(lens, coating_),
      tables_(size_t(lens.size())) {
    for (int i = 0; i < lens.size(); ++i) {
        Table& table = tables_[size_t(i)];
        const auto& s = lens.surfaces<double>()[size_t(i)];
        table.touches_air = touches_air(s);
        table.formula = coating_ <= Coating::MgF2 || s.medium_before == s.medium_after;
        if (table.formula) continue;
        int finer = 1;
        while (finer <= kMostFiner && !fits(i, finer * kWaves, finer * kCosines)) finer *= 2;
        if (finer > kMostFiner) continue;
        table.waves = finer * kWaves;
        table.cosines = finer * kCosines;
        for (int j = 0; j <= table.waves; ++j)
            for (int k = 0; k <= table.cosines; ++k)
                table.share.push_back(static_cast<float>(
                    exact(i, double(k) / table.cosines, wave_nm(j, table.waves))));
    }
}

// A surface lets as much through from one side as from the other, absorbing or not (Macleod 2010,
// ch. 2), so this is the side on which no light is totally reflected.
double CoatTables::exact(int surface, double cosine, double nm) const {
    const auto& s = lens_->surfaces<double>()[size_t(surface)];
    const double before = lens_->media()[s.medium_before].index(nm),
                 after = lens_->media()[s.medium_after].index(nm);
    return coats_
        .at(surface, before <= after ? Towards::Film : Towards::Scene,
            {std::min(before, after), std::max(before, after), cosine, nm})
        .transmitted;
}

// Whether so many cells are enough, by cells drawn with a fixed seed: straight lines are worst in
// their middle.
bool CoatTables::fits(int surface, int waves, int cosines) const {
    constexpr int kDraws = 200;
    constexpr double kClose = 5e-4, kLeastCosine = 0.1;
    std::minstd_rand random(1);
    const auto draw = [&](int first, int end) {
        return first + int(random() % unsigned(end - first));
    };
    for (int n = 0; n < kDraws; ++n) {
        const int j = draw(0, waves), k = draw(int(kLeastCosine * cosines), cosines);
        const auto at = [&](double wave, double cosine) {
            return exact(surface, (k + cosine) / cosines, wave_nm(j + wave, waves));
        };
        const double joined = (at(0, 0) + at(0, 1) + at(1, 0) + at(1, 1)) / 4;
        if (std::fabs(joined - at(0.5, 0.5)) > kClose) return false;
    }
    return true;
}

f4 CoatTables::transmittance(int surface, const Crossing& c, f4 nm) const {
    const Table& table = tables_[size_t(surface)];
    if (table.formula) return camera::transmittance(coating_, c, table.touches_air, nm);
    const f4 ratio = max(c.index_from / c.index_into, splat(1.f));
    const f4 cosine =
        min(sqrt(max(1 - ratio * ratio * (1 - c.cosine * c.cosine), f4{})), splat(1.f));
    f4 out;
    for (int lane = 0; lane < 4; ++lane) {
        if (table.waves == 0) {
            out[lane] = float(exact(surface, double(cosine[lane]), double(nm[lane])));
            continue;
        }
        const float x = cosine[lane] * float(table.cosines);
        const float y = std::clamp(
            (nm[lane] - float(kFirst_nm)) * float(table.waves) / float(kLast_nm - kFirst_nm), 0.f,
            float(table.waves));
        const int i = std::min(int(x), table.cosines - 1), j = std::min(int(y), table.waves - 1);
        const float u = x - float(i), v = y - float(j);
        const float* const at = table.share.data() + j * (table.cosines + 1) + i;
        const auto row = [u](const float* a) { return a[0] * (1 - u) + a[1] * u; };
        out[lane] = row(at) * (1 - v) + row(at + table.cosines + 1) * v;
    }
    return out;
}

}  // namespace petzval::camera
