// SPDX-License-Identifier: Apache-2.0
#include "integrator/denoise/denoise.h"

#include <immintrin.h>

#include <span>
#include <vector>

#include "integrator/denoise/half_tile.h"

namespace petzval::integrator {
namespace {

constexpr int kTile = kDenoiserTile_px, kSide = HalfTile::kSide;
/// Radius of the window, whose pixels a pixel is estimated from.
constexpr int kWindow_px = 7;
constexpr int kOffsets = (2 * kWindow_px + 1) * (2 * kWindow_px + 1);
static_assert(kWindow_px + 1 + 2 + 2 <= HalfTile::kReach,
              "the window, patches, shared variances and lonely pixels");

// Factors on differences of guides that bring them to about 1: of the distance's logarithm, where
// it is a fourth more.
constexpr float guide_scale(size_t g) {
    return g < 3 ? 2.f : g == 6 ? 266.f : 1.f;
}

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

/// Weights of the pixels of a window, for all pixels of a tile, for an estimate that keeps detail.
class WindowWeights {
  public:
    explicit WindowWeights(const HalfTile& half) : half_(half), weights_(kOffsets * kTile * kTile) {
        int n = 0;
        for (int dy = -kWindow_px; dy <= kWindow_px; ++dy)
            for (int dx = -kWindow_px; dx <= kWindow_px; ++dx)
                weigh(dy * kSide + dx, &weights_[static_cast<size_t>(kTile * kTile * n++)]);
    }
    /// Of eight pixels of the tile, and the n-th pixel of their windows.
    [[nodiscard]] f8 of(int n, int x, int y) const {
        return load8(&weights_[static_cast<size_t>((n * kTile + y) * kTile + x)]);
    }

  private:
    void weigh(int offset, float* to) const;
    [[nodiscard]] f8 distance(int i, int offset, f8& both) const;

    const HalfTile& half_;
    std::vector<float> weights_;
};

// Squared difference of eight pixels from others, without what their noise adds, in units of it
// (Rousselle, Knaus and Zwicker 2012, "Adaptive Rendering with Non-Local Means Filtering",
// equation 3).
f8 WindowWeights::distance(int i, int offset, f8& both) const {
    constexpr float kPrecision = 0.25f;  // k^2 of that equation; 1 for the smoother estimate
    const auto p = static_cast<size_t>(i), q = static_cast<size_t>(i + offset);
    f8 sum = splat8(0);
    for (size_t c = 0; c < 3; ++c) {
        const f8 e = load8(&half_.colour[c][p]) - load8(&half_.colour[c][q]);
        const f8 own = load8(&half_.variance[c][p]), other = load8(&half_.variance[c][q]);
        sum += (e * e - (own + min(own, other))) / (1e-10f + kPrecision * (own + other));
    }
    both = load8(&half_.inside[p]) * load8(&half_.inside[q]);
    return both * (1.f / 3.f) * sum;
}

// Patches are of 3 x 3 pixels.
void WindowWeights::weigh(int offset, float* to) const {
    constexpr int kRow = kTile + 8;
    std::array<float, (kTile + 2) * kRow> across, valid;  // sums of three in a row, and of pixels
    std::array<float, kRow + 8> row, there;
    for (int y = -1; y <= kTile; ++y) {
        for (int x = -1; x < kTile + 1; x += 8) {
            f8 both;
            store8(&row[size_t(x + 1)], distance(HalfTile::index(x, y), offset, both));
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
                   load8(&half_.inside[static_cast<size_t>(other)]) * exp_minus(mean));
        }
}

/// Regressors of a pixel of the window: 1, differences of the guides, and its place.
constexpr size_t kRegressors = 1 + kGuideNumbers + 2;
using Regressors = std::array<f8, kRegressors>;

/// Linear regression about eight pixels. The estimate of a pixel is the regression's value there: a
/// sum over its window, of which the shares are solved for.
class Regression {
  public:
    Regression(const HalfTile& half, const WindowWeights& weights, bool is_smoother, int x, int y)
        : half_(half),
          weights_(weights),
          is_smoother_(is_smoother),
          x_(x),
          y_(y),
          centre_(HalfTile::index(x, y)) {
        for (size_t g = 0; g < kGuideNumbers; ++g)
            own_[g] = load8(&half.guide[g][static_cast<size_t>(centre_)]);
        add_up();
        solve();
    }
    /// Writes the estimates of planes, such as R, G and B, each a sum of the window's values by the
    /// same shares. Shares below 0 are left out: no estimate lies beyond the window's values, none
    /// is negative.
    void estimate(std::span<const HalfTile::Plane> planes, f8* out) const;
    /// Standard errors of the estimates of R, G and B, as far as the variances tell: their sum.
    [[nodiscard]] f8 deviation() const;

  private:
    // Calls use(weight, regressors, index) for the pixels of the window that have a weight.
    template <class Use>
    void each_pixel(const Use& use) const {
        int n = 0;
        for (int dy = -kWindow_px; dy <= kWindow_px; ++dy)
            for (int dx = -kWindow_px; dx <= kWindow_px; ++dx, ++n) {
                f8 weight = weights_.of(n, x_, y_);
                if (is_smoother_) weight = sqrt(sqrt(weight));  // e^-a/4: four times k^2
                // A ten-thousandth of a lamp would be seen in the dark beside it.
                const m8 counts = weight > (is_smoother_ ? 0.05f : 1e-4f);
                if (_mm256_movemask_ps((__m256)counts) == 0) continue;
                const auto q = static_cast<size_t>(centre_ + dy * kSide + dx);
                Regressors at;
                at[0] = splat8(1);
                for (size_t g = 0; g < kGuideNumbers; ++g)
                    at[1 + g] = guide_scale(g) * (load8(&half_.guide[g][q]) - own_[g]);
                at[1 + kGuideNumbers] = splat8(float(dx) / kWindow_px);
                at[2 + kGuideNumbers] = splat8(float(dy) / kWindow_px);
                use(counts ? weight : splat8(0), at, q);
            }
    }
    /// Calls use(share, index) for the pixels of the window. Returns the sum of the shares.
    template <class Use>
    f8 each_share(const Use& use) const;
    void add_up();
    void solve();

    const HalfTile& half_;
    const WindowWeights& weights_;
    bool is_smoother_;
    int x_, y_, centre_;
    std::array<f8, kGuideNumbers> own_;
    std::array<Regressors, kRegressors> matrix_{};  ///< lower half; then its Cholesky factor
    Regressors shares_;
};

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
    constexpr float kRidge = 1e-2f;
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

void Regression::estimate(std::span<const HalfTile::Plane> planes, f8* out) const {
    for (size_t i = 0; i < planes.size(); ++i) out[i] = splat8(0);
    const f8 all = each_share([&](f8 share, size_t q) {
        for (size_t i = 0; i < planes.size(); ++i) out[i] += share * load8(&planes[i][q]);
    });
    for (size_t i = 0; i < planes.size(); ++i) out[i] /= all;
}

f8 Regression::deviation() const {
    std::array<f8, 3> variance{};
    const f8 all = each_share([&](f8 share, size_t q) {
        for (size_t c = 0; c < 3; ++c) variance[c] += share * share * load8(&half_.variance[c][q]);
    });
    return (sqrt(variance[0]) + sqrt(variance[1]) + sqrt(variance[2])) / all;
}

// The smoother estimate takes noisy lamps for what the dark beside them may be, too. So it goes no
// further from the first one than three deviations of that: in the dark these are 0.
f8 way_to_smoother(const Regression& first, const std::array<f8, 3>& from,
                   const std::array<f8, 3>& to) {
    constexpr float kDeviations = 3;
    f8 way = splat8(1e-30f);
    for (size_t c = 0; c < 3; ++c) way += max(to[c] - from[c], from[c] - to[c]);
    return min(splat8(1), kDeviations * first.deviation() / way);
}

/// Writes the estimates of eight pixels, as far as they lie in the tile.
class EstimateWriter {
  public:
    EstimateWriter(HalfEstimates& out, uint32_t half) : out_(out), half_(half) {}
    void write(size_t estimate, int x, int y, int count, const std::array<f8, 3>& colour,
               const std::vector<f8>& bins) {
        for (int lane = 0; lane < count; ++lane) {
            const size_t at = out_.offset(x + lane, y);
            out_.colour[half_][estimate][at] = {colour[0][lane], colour[1][lane], colour[2][lane]};
            for (size_t b = 0; b < bins.size(); ++b)
                out_.bins[estimate][at * bins.size() + b] += bins[b][lane] / kHalves;
        }
    }

  private:
    HalfEstimates& out_;
    uint32_t half_;
};

}  // namespace

void estimate_tile(const Film& film, const Rect& tile, HalfEstimates& out) {
    std::vector<f8> bins(out.bins_each), smooth_bins(out.bins_each);
    for (uint32_t number = 0; number < kHalves; ++number) {
        const auto half = std::make_unique<HalfTile>(film, V2i(tile.x0, tile.y0), number);
        const WindowWeights weights(*half);
        EstimateWriter writer(out, number);
        for (int y = 0; y < tile.height(); ++y)
            for (int x = 0; x < tile.width(); x += 8) {
                const int count = std::min(8, tile.width() - x);
                const Regression first(*half, weights, false, x, y);
                std::array<f8, 3> colour, smooth;
                first.estimate(half->colour, colour.data());
                if (!bins.empty()) first.estimate(half->bins, bins.data());
                writer.write(0, tile.x0 + x, tile.y0 + y, count, colour, bins);
                if (!out.can_choose) continue;
                const Regression second(*half, weights, true, x, y);
                second.estimate(half->colour, smooth.data());
                if (!bins.empty()) second.estimate(half->bins, smooth_bins.data());
                const f8 way = way_to_smoother(first, colour, smooth);
                for (size_t c = 0; c < 3; ++c)
                    smooth[c] = (1.f - way) * colour[c] + way * smooth[c];
                for (size_t b = 0; b < bins.size(); ++b)
                    smooth_bins[b] = (1.f - way) * bins[b] + way * smooth_bins[b];
                writer.write(1, tile.x0 + x, tile.y0 + y, count, smooth, smooth_bins);
            }
    }
}

}  // namespace petzval::integrator
