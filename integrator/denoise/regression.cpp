// SPDX-License-Identifier: Apache-2.0
#include "integrator/denoise/regression.h"

#include <immintrin.h>

namespace petzval::integrator {
namespace {

// Factors on differences of guides that bring them to about 1: of the distance's logarithm, where
// it is a fourth more.
constexpr float guide_scale(size_t g) {
    return g < 3 ? 2.f : g == 6 ? 266.f : 1.f;
}

}  // namespace

Regression::Regression(const HalfTile& half, const WindowWeights& weights, WeightsAs as, int x,
                       int y)
    : half_(half), weights_(weights), as_(as), x_(x), y_(y), centre_(HalfTile::index(x, y)) {
    for (size_t g = 0; g < kGuideNumbers; ++g)
        own_[g] = load8(&half.guide[g][static_cast<size_t>(centre_)]);
    add_up();
    solve();
}

template <class Use>
void Regression::each_pixel(const Use& use) const {
    int n = 0;
    for (int dy = -kWindow_px; dy <= kWindow_px; ++dy)
        for (int dx = -kWindow_px; dx <= kWindow_px; ++dx, ++n) {
            f8 weight = weights_.of(n, x_, y_);
            if (as_.fourth_root) weight = sqrt(sqrt(weight));
            const m8 counts = weight > as_.least;
            if (_mm256_movemask_ps((__m256)counts) == 0) continue;
            const auto q = static_cast<size_t>(centre_ + dy * HalfTile::kSide + dx);
            Regressors at;
            at[0] = splat8(1);
            for (size_t g = 0; g < kGuideNumbers; ++g)
                at[1 + g] = guide_scale(g) * (load8(&half_.guide[g][q]) - own_[g]);
            at[1 + kGuideNumbers] = splat8(float(dx) / kWindow_px);
            at[2 + kGuideNumbers] = splat8(float(dy) / kWindow_px);
            use(counts ? weight : splat8(0), at, q);
        }
}

void Regression::add_up() {
    each_pixel([&](f8 weight, const Regressors& at, size_t) {
        for (size_t a = 0; a < kRegressors; ++a) {
            const f8 weighted = weight * at[a];
            for (size_t b = 0; b <= a; ++b) matrix_[a][b] += weighted * at[b];
        }
    });
}

// Solves matrix shares = (1, 0 ... 0), with a ridge (Hoerl and Kennard 1970) where the guides do
// not vary.
void Regression::solve() {
    constexpr float kRidge = 3e-2f;
    const f8 ridge = kRidge * matrix_[0][0] + 1e-12f;
    for (size_t a = 1; a < kRegressors; ++a) matrix_[a][a] += ridge;
    matrix_[0][0] += 1e-12f;
    for (size_t a = 0; a < kRegressors; ++a)
        for (size_t b = 0; b <= a; ++b) {
            f8 rest = matrix_[a][b];
            for (size_t k = 0; k < b; ++k) rest -= matrix_[a][k] * matrix_[b][k];
            matrix_[a][b] = a == b ? sqrt(max(rest, splat8(1e-12f))) : rest / matrix_[b][b];
        }
    Regressors z;
    for (size_t a = 0; a < kRegressors; ++a) {
        f8 rest = splat8(a == 0 ? 1.f : 0.f);
        for (size_t k = 0; k < a; ++k) rest -= matrix_[a][k] * z[k];
        z[a] = rest / matrix_[a][a];
    }
    for (size_t a = kRegressors; a-- > 0;) {
        f8 rest = z[a];
        for (size_t k = a + 1; k < kRegressors; ++k) rest -= matrix_[k][a] * shares_[k];
        shares_[a] = rest / matrix_[a][a];
    }
}

template <class Use>
f8 Regression::each_share(const Use& use) const {
    f8 all = splat8(0);
    each_pixel([&](f8 weight, const Regressors& at, size_t q) {
        f8 share = splat8(0);
        for (size_t a = 0; a < kRegressors; ++a) share += shares_[a] * at[a];
        share = weight * max(share, splat8(0));
        all += share;
        use(share, q);
    });
    // A pixel always has a weight for itself; beyond the frame there is none.
    return max(all, splat8(1e-30f));
}

ColourEstimate Regression::colour() const {
    ColourEstimate out{};
    const f8 all = each_share([&](f8 share, size_t q) {
        for (size_t c = 0; c < 3; ++c) {
            out.mean[c] += share * load8(&half_.colour[c][q]);
            out.variance[c] += share * share * load8(&half_.variance[c][q]);
        }
    });
    for (size_t c = 0; c < 3; ++c) out.mean[c] /= all, out.variance[c] /= all * all;
    return out;
}

void Regression::estimate(std::span<const HalfTile::Plane> planes, f8* out) const {
    for (size_t i = 0; i < planes.size(); ++i) out[i] = splat8(0);
    const f8 all = each_share([&](f8 share, size_t q) {
        for (size_t i = 0; i < planes.size(); ++i) out[i] += share * load8(&planes[i][q]);
    });
    for (size_t i = 0; i < planes.size(); ++i) out[i] /= all;
}

}  // namespace petzval::integrator
