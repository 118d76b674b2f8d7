// SPDX-License-Identifier: Apache-2.0
#include "camera/lens/lens_coats.h"

#include <algorithm>
#include <numeric>

namespace petzval {
namespace {

constexpr int kCosines = 128;

double thickness_nm(const LayerStack& layers) {
    return std::accumulate(layers.begin(), layers.end(), 0.,
                           [](double sum, const Layer& a) { return sum + a.thickness_nm; });
}

}  // namespace

LensCoats::LensCoats(const Lens& lens, Coating coating) : coats_(size_t(lens.size())) {
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
    : coating_(coating), tables_(size_t(lens.size())) {
    const LensCoats coats(lens, coating);
    for (int i = 0; i < lens.size(); ++i) {
        Table& table = tables_[size_t(i)];
        const auto& s = lens.surfaces<double>()[size_t(i)];
        table.touches_air = touches_air(s);
        if (coating <= Coating::MgF2 || s.medium_before == s.medium_after) continue;
        table.step_nm = thickness_nm(coats.layers(i)) > 2000 ? 1 : 10;
        for (int nm = kFirst_nm; nm <= kLast_nm; nm += table.step_nm) {
            const double before = lens.media()[s.medium_before].index(double(nm)),
                         after = lens.media()[s.medium_after].index(double(nm));
            const bool to_film = before <= after;
            for (int k = 0; k <= kCosines; ++k)
                table.share.push_back(
                    static_cast<float>(coats
                                           .at(i, to_film ? Towards::Film : Towards::Scene,
                                               {std::min(before, after), std::max(before, after),
                                                double(k) / kCosines, double(nm)})
                                           .transmitted));
        }
    }
}

f4 CoatTables::transmittance(int surface, const Crossing& c, f4 nm) const {
    const Table& table = tables_[size_t(surface)];
    if (table.step_nm == 0) return petzval::transmittance(coating_, c, table.touches_air, nm);
    // A surface lets as much through from one side as from the other, absorbing or not (Macleod
    // 2010, ch. 2), so the table has the side on which no light is totally reflected.
    const f4 ratio = max(c.index_from / c.index_into, splat(1.f));
    const f4 cosine = sqrt(max(1 - ratio * ratio * (1 - c.cosine * c.cosine), f4{}));
    const int last = (kLast_nm - kFirst_nm) / table.step_nm;
    f4 out;
    for (int lane = 0; lane < 4; ++lane) {
        const float x = std::clamp(cosine[lane], 0.f, 1.f) * kCosines;
        const float y =
            std::clamp((nm[lane] - float(kFirst_nm)) / float(table.step_nm), 0.f, float(last));
        const int i = std::min(int(x), kCosines - 1), j = std::min(int(y), last - 1);
        const float u = x - float(i), v = y - float(j);
        const float* const at = table.share.data() + j * (kCosines + 1) + i;
        const auto row = [u](const float* a) { return a[0] * (1 - u) + a[1] * u; };
        out[lane] = row(at) * (1 - v) + row(at + kCosines + 1) * v;
    }
    return out;
}

}  // namespace petzval
