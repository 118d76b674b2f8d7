// SPDX-License-Identifier: Apache-2.0
#include "core/spectrum/observer.h"

#include <algorithm>

#include "core/spectrum/colour.h"

namespace petzval {
namespace {

// Spectral radiance, W/(m2 sr nm), of a light at 1 nit, over its power in whatever unit.
double per_nit(const SpectrumTable& light, const SpectrumTable& y_bar) {
    return 1. / (kLuminousEfficacy_lm_per_w * integral_of_product(light, y_bar));
}

f4 mix(f4 a, f4 b, float t) {
    return a * (1.f - t) + b * t;
}

// Sampling weights of wavelengths, one for each cell of 1 nm. For a grey scene under one light the
// summed variance of R, G and B is least in proportion to the light times the length of the
// sensor's response; a twentieth is kept for light of any other spectrum. Half of that goes where
// the eye sees: a sensor may be blind there, and XYZ is not.
std::vector<float> sensor_weights(const ObserverInput& in, const std::vector<f4>& response,
                                  const std::vector<f4>& eye) {
    std::vector<const SpectrumTable*> lights{&in.white};
    for (const SpectrumTable& light : in.lights) lights.push_back(&light);
    std::vector<double> sum(kSpectrumSize - 1);
    const auto add = [&](const std::vector<f4>& sensor, const SpectrumTable* light, double share) {
        std::vector<double> weight(sum.size());
        double total = 0;
        for (size_t i = 0; i < sum.size(); ++i) {
            const f4 r = sensor[i] + sensor[i + 1];
            weight[i] = std::sqrt(double(r[0]) * r[0] + double(r[1]) * r[1] + double(r[2]) * r[2]);
            if (light) weight[i] *= double(light->value[i]) + light->value[i + 1];
            total += weight[i];
        }
        if (!(total > 0)) return;
        for (size_t i = 0; i < sum.size(); ++i) sum[i] += share * weight[i] / total;
    };
    for (const SpectrumTable* light : lights) add(response, light, 0.95 / double(lights.size()));
    add(response, nullptr, 0.025);
    add(eye, nullptr, 0.025);
    return {sum.begin(), sum.end()};
}

// Mixes in a weight that is even over the bins, as one half of the whole.
void mix_in(const Bins& bins, std::vector<float>& weights) {
    double total = 0;
    for (const float w : weights) total += w;
    const double range_nm = bins.last_edge_nm() - bins.first_edge_nm;
    for (size_t i = 0; i < weights.size(); ++i) {
        const double left = double(kFirst_nm) + double(i);
        const double overlap_nm =
            std::min(left + 1, bins.last_edge_nm()) - std::max(left, bins.first_edge_nm);
        weights[i] = static_cast<float>(0.5 * weights[i] / total +
                                        0.5 * std::max(overlap_nm, 0.) / range_nm);
    }
}

}  // namespace

Observer::Observer(const ObserverInput& in) : rows_(kSpectrumSize), bins_(in.bins) {
    const double white = per_nit(in.white, in.xyz_bar[1]);
    std::vector<f4> response(kSpectrumSize), eye(kSpectrumSize);
    for (size_t i = 0; i < rows_.size(); ++i) {
        Row& row = rows_[i];
        for (int c = 0; c < 3; ++c) {
            row.basis_white[c] = in.basis[static_cast<size_t>(c)].value[i];
            row.xyz_bar[c] =
                kLuminousEfficacy_lm_per_w * in.xyz_bar[static_cast<size_t>(c)].value[i];
            const V3f& m = in.matrix[static_cast<size_t>(c)];
            row.to_rgb[c] = kLuminousEfficacy_lm_per_w *
                            (m.x * in.response[0].value[i] + m.y * in.response[1].value[i] +
                             m.z * in.response[2].value[i]);
        }
        row.basis_white[3] = static_cast<float>(in.white.value[i] * white);
        response[i] = row.to_rgb;
        eye[i] = row.xyz_bar;
    }
    std::vector<float> weights = sensor_weights(in, response, eye);
    if (bins_) mix_in(*bins_, weights);
    density_ = Piecewise1D(weights);
}

float Observer::pdf(float nm) const {
    const int cell = static_cast<int>(nm) - kFirst_nm;
    return density_.probability(static_cast<uint32_t>(std::clamp(cell, 0, kSpectrumSize - 2)));
}

Bands Observer::draw(float u) const {
    if (!spectral()) return Bands::rgb();
    f4 nm, pdf;
    for (int i = 0; i < 4; ++i) {
        const float turn = 0.25f * static_cast<float>(i);
        const float turned = u < 1.f - turn ? u + turn : u - (1.f - turn);
        const Piecewise1D::Draw drawn = density_.sample(turned);
        nm[i] = static_cast<float>(kFirst_nm) + static_cast<float>(drawn.cell) + drawn.offset;
        pdf[i] = drawn.probability;  // the cell is 1 nm wide
    }
    return at(nm, pdf, m4{-1, -1, -1, -1});
}

Bands Observer::at(f4 nm, f4 pdf, m4 on) const {
    Bands bands;
    bands.nm = nm;
    bands.pdf = pdf;
    bands.on = on;
    bands.spectral = true;
    while (bands.hero < 3 && !on[bands.hero]) ++bands.hero;
    const auto lanes = static_cast<float>(lane_count(on));
    std::array<f4, 4> basis{}, out{};
    for (int i = 0; i < 4; ++i) {
        if (!on[i]) continue;
        const Row row = at(nm[i]);
        basis[size_t(i)] = row.basis_white;
        out[size_t(i)] = row.to_rgb / (pdf[i] * lanes);
    }
    basis = transposed(basis), out = transposed(out);
    bands.red = basis[0], bands.green = basis[1], bands.blue = basis[2], bands.white = basis[3];
    bands.to_r = out[0], bands.to_g = out[1], bands.to_b = out[2];
    return bands;
}

Observer::Row Observer::at(float nm) const {
    const float place = nm - static_cast<float>(kFirst_nm);
    const int k = std::clamp(static_cast<int>(place), 0, kSpectrumSize - 2);
    const float t = place - static_cast<float>(k);
    const Row& a = rows_[static_cast<size_t>(k)];
    const Row& b = rows_[static_cast<size_t>(k) + 1];
    return {mix(a.basis_white, b.basis_white, t), mix(a.to_rgb, b.to_rgb, t),
            mix(a.xyz_bar, b.xyz_bar, t)};
}

V3f Observer::to_xyz(f4 radiance, const Bands& bands) const {
    if (!spectral()) return V3f(0.f);
    f4 sum{};
    for (int i = 0; i < 4; ++i)
        if (bands.on[i]) sum += at(bands.nm[i]).xyz_bar * (radiance[i] / bands.pdf[i]);
    sum *= 1.f / static_cast<float>(lane_count(bands.on));
    return {sum[0], sum[1], sum[2]};
}

}  // namespace petzval
