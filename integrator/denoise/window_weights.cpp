// SPDX-License-Identifier: Apache-2.0
#include "integrator/denoise/window_weights.h"

namespace petzval::integrator {
namespace {

constexpr int kTile = kDenoiserTile_px;
constexpr int kOffsets = (2 * kWindow_px + 1) * (2 * kWindow_px + 1);

/// e^-a for a >= 0, to 2e-4: 2^x by its bits, and a polynomial in between.
f8 exp_minus(f8 a) {
    const f8 x = max(-1.44269504f * a, splat8(-100.f));
    const m8 whole = __builtin_convertvector(x, m8) - 1;  // towards 0 and less: the rest is 0 to 1
    const f8 rest = x - __builtin_convertvector(whole, f8);
    const f8 half = 0.5f * rest;  // 2^rest is the square of 2^half
    const f8 root =
        1.f + half * (0.6931472f + half * (0.2402265f + half * (0.0555041f + half * 0.0096838f)));
    return root * root * (f8)((whole + 127) << 23);
}

// Squared difference of eight pixels from others, without what their noise adds, in units of it
// (Rousselle, Knaus and Zwicker 2012, "Adaptive Rendering with Non-Local Means Filtering",
// equation 3).
f8 distance(const Compared& of, int i, int offset, f8& both) {
    const auto p = static_cast<size_t>(i), q = static_cast<size_t>(i + offset);
    // Where there is no noise, colours that differ by 1e-5 of their size are alike. It is a share
    // of the light, so that dim pictures are denoised as bright ones are.
    constexpr float kSquare = 1e-10f, kNotZero = 1e-30f;
    f8 sum = splat8(0);
    for (size_t c = 0; c < 3; ++c) {
        const f8 a = load8(&of.colour[c][p]), b = load8(&of.colour[c][q]), e = a - b;
        const f8 own = load8(&of.variance[c][p]), other = load8(&of.variance[c][q]);
        sum += (e * e - (own + min(own, other))) /
               (kNotZero + kSquare * (a * a + b * b) + of.precision * (own + other));
    }
    both = load8(&of.inside[p]) * load8(&of.inside[q]);
    return both * (1.f / 3.f) * sum;
}

// Patches are of 3 x 3 pixels.
void weigh(const Compared& of, int offset, float* to) {
    constexpr int kRow = kTile + 8;
    std::array<float, (kTile + 2) * kRow> across, valid;  // sums of three in a row, and of pixels
    std::array<float, kRow + 8> row, there;
    for (int y = -1; y <= kTile; ++y) {
        for (int x = -1; x < kTile + 1; x += 8) {
            f8 both;
            store8(&row[size_t(x + 1)], distance(of, HalfTile::index(x, y), offset, both));
            store8(&there[size_t(x + 1)], both);
        }
        const auto at = static_cast<size_t>((y + 1) * kRow);
        for (size_t x = 0; x < kTile; x += 8) {
            store8(&across[at + x], load8(&row[x]) + load8(&row[x + 1]) + load8(&row[x + 2]));
            store8(&valid[at + x], load8(&there[x]) + load8(&there[x + 1]) + load8(&there[x + 2]));
        }
    }
    for (size_t y = 0; y < kTile; ++y)
        for (size_t x = 0; x < kTile; x += 8) {
            const size_t at = y * kRow + x;
            const f8 sum =
                load8(&across[at]) + load8(&across[at + kRow]) + load8(&across[at + 2 * kRow]);
            const f8 count =
                load8(&valid[at]) + load8(&valid[at + kRow]) + load8(&valid[at + 2 * kRow]);
            const f8 mean = max(sum / max(count, splat8(1)), splat8(0));
            const int other = HalfTile::index(static_cast<int>(x), static_cast<int>(y)) + offset;
            store8(to + y * kTile + x,
                   load8(&of.inside[static_cast<size_t>(other)]) * exp_minus(mean));
        }
}

}  // namespace

WindowWeights::WindowWeights(const Compared& of)
    : weights_(static_cast<size_t>(kOffsets * kTile * kTile)) {
    int n = 0;
    for (int dy = -kWindow_px; dy <= kWindow_px; ++dy)
        for (int dx = -kWindow_px; dx <= kWindow_px; ++dx)
            weigh(of, dy * HalfTile::kSide + dx,
                  &weights_[static_cast<size_t>(kTile * kTile * n++)]);
}

}  // namespace petzval::integrator
