// SPDX-License-Identifier: Apache-2.0
#include "integrator/denoise/denoise.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "integrator/denoise/half_tile.h"
#include "integrator/denoise/regression.h"

namespace petzval::integrator {
namespace {

static_assert(kWindow_px + 1 + 2 + 2 <= HalfTile::kReach,
              "the window, patches, shared variances and lonely pixels");
static_assert(kWindow_px + 1 == kPilotReach_px);
static_assert(kShrinkageReach_px + kPilotReach_px + HalfTile::kReach == kDenoiserReach_px);

// k^2 of the weights: samples are compared strictly, so that detail stays. Pilots are smooth, and
// their errors are alike in neighbours: they are compared in larger units.
constexpr float kOfSamples = 0.25f, kOfPilots = 4;
constexpr WeightsAs kFirst{false, 1e-4f}, kSecond{false, 1e-3f};
/// k^2 is 1. A ten-thousandth of a lamp would be seen in the dark beside it.
constexpr WeightsAs kPilot{true, 0.05f};

using Colour8 = std::array<f8, 3>;

f8 deviation_of(const ColourEstimate& e) {
    return sqrt(e.variance[0]) + sqrt(e.variance[1]) + sqrt(e.variance[2]);
}

/// Calls use(x, y, count) for the pixels of a tile, eight at once: places in the tile, and how many
/// of the eight lie in it.
template <class Use>
void each_eight_of(const Rect& tile, const Use& use) {
    for (int y = 0; y < tile.height(); ++y)
        for (int x = 0; x < tile.width(); x += 8) use(x, y, std::min(8, tile.width() - x));
}

/// Writes estimates of a half, eight pixels at once, as far as there is room for them.
class EstimateWriter {
  public:
    EstimateWriter(HalfEstimates& out, uint32_t half) : out_(out), half_(half) {}
    void write(size_t estimate, int x, int y, int count, const Colour8& colour,
               const std::vector<f8>& bins) {
        for (int lane = 0; lane < count; ++lane) {
            if (!contains(out_.pixels, x + lane, y)) continue;
            const size_t at = out_.offset(x + lane, y);
            out_.colour[half_][estimate][at] = {colour[0][lane], colour[1][lane], colour[2][lane]};
            for (size_t b = 0; b < bins.size(); ++b)
                out_.bins[half_][estimate][at * bins.size() + b] = bins[b][lane];
        }
    }

  private:
    static bool contains(const Rect& r, int x, int y) {
        return x >= r.x0 && x < r.x1 && y >= r.y0 && y < r.y1;
    }

    HalfEstimates& out_;
    uint32_t half_;
};

void write_pilots(const ColourEstimate& pilot, f8 first_deviation, size_t at, int count,
                  uint32_t half, Pilots& out) {
    for (int lane = 0; lane < count; ++lane, ++at) {
        for (int c = 0; c < 3; ++c) {
            out.colour[half][at][c] = pilot.mean[static_cast<size_t>(c)][lane];
            out.variance[half][at][c] = pilot.variance[static_cast<size_t>(c)][lane];
        }
        out.first_deviation[half][at] = first_deviation[lane];
    }
}

/// Pilot estimates about a tile; 0 beyond the frame.
struct PilotTile {
    std::array<HalfTile::Plane, 3> colour{}, variance{};

    PilotTile(const Pilots& pilots, const Rect& tile, uint32_t half) {
        const Rect there = grown(tile, kPilotReach_px, pilots.pixels);
        for (int y = there.y0; y < there.y1; ++y)
            for (int x = there.x0; x < there.x1; ++x) {
                const auto to = static_cast<size_t>(HalfTile::index(x - tile.x0, y - tile.y0));
                const size_t from = pilots.offset(x, y);
                for (int c = 0; c < 3; ++c) {
                    colour[static_cast<size_t>(c)][to] = pilots.colour[half][from][c];
                    variance[static_cast<size_t>(c)][to] = pilots.variance[half][from][c];
                }
            }
    }
};

/// First estimates of a half, eight pixels of a tile at once; 0 beyond `count`.
class FirstEstimates {
  public:
    FirstEstimates(const HalfEstimates& from, const Pilots& pilots, const Rect& tile, uint32_t half)
        : from_(from), pilots_(pilots), tile_(tile), half_(half) {}
    [[nodiscard]] Colour8 colour(int x, int y, int count) const {
        Colour8 out{};
        const V3f* at = &from_.colour[half_][0][offset(x, y)];
        for (int lane = 0; lane < count; ++lane)
            for (int c = 0; c < 3; ++c) out[static_cast<size_t>(c)][lane] = at[lane][c];
        return out;
    }
    [[nodiscard]] f8 bin(int x, int y, int count, size_t bin) const {
        f8 out = splat8(0);
        const float* at = &from_.bins[half_][0][offset(x, y) * from_.bins_each + bin];
        for (int lane = 0; lane < count; ++lane)
            out[lane] = at[static_cast<size_t>(lane) * from_.bins_each];
        return out;
    }
    /// Standard errors of R, G and B: their sum.
    [[nodiscard]] f8 deviation(int x, int y, int count) const {
        f8 out = splat8(0);
        const float* at =
            &pilots_.first_deviation[half_][pilots_.offset(tile_.x0 + x, tile_.y0 + y)];
        for (int lane = 0; lane < count; ++lane) out[lane] = at[lane];
        return out;
    }

  private:
    [[nodiscard]] size_t offset(int x, int y) const {
        return from_.offset(tile_.x0 + x, tile_.y0 + y);
    }

    const HalfEstimates& from_;
    const Pilots& pilots_;
    Rect tile_;
    uint32_t half_;
};

// What of the way from the first to the second estimate is gone: no more than three standard errors
// of the first. The second one takes noisy lamps for what the dark beside them may be, too. In the
// dark these errors are 0.
f8 way_to_second(const Colour8& first, f8 first_deviation, const Colour8& second) {
    constexpr float kDeviations = 3;
    f8 way = splat8(1e-30f);
    for (size_t c = 0; c < 3; ++c) way += max(second[c] - first[c], first[c] - second[c]);
    return min(splat8(1), kDeviations * first_deviation / way);
}

}  // namespace

void estimate_first(const Film& film, const Rect& tile, HalfEstimates& out, Pilots& pilots) {
    std::vector<f8> bins(out.bins_each);
    for (uint32_t number = 0; number < kHalves; ++number) {
        const auto half = std::make_unique<HalfTile>(film, V2i(tile.x0, tile.y0), number);
        const WindowWeights weights({half->colour, half->variance, half->inside, kOfSamples});
        EstimateWriter writer(out, number);
        each_eight_of(tile, [&](int x, int y, int count) {
            const Regression first(*half, weights, kFirst, x, y);
            const ColourEstimate colour = first.colour();
            if (!bins.empty()) first.estimate(half->bins, bins.data());
            writer.write(0, tile.x0 + x, tile.y0 + y, count, colour.mean, bins);
            if (!out.can_choose) return;
            const ColourEstimate pilot = Regression(*half, weights, kPilot, x, y).colour();
            write_pilots(pilot, deviation_of(colour), pilots.offset(tile.x0 + x, tile.y0 + y),
                         count, number, pilots);
        });
    }
}

void estimate_second(const Film& film, const Rect& tile, const Pilots& pilots, HalfEstimates& out) {
    std::vector<f8> bins(out.bins_each);
    for (uint32_t number = 0; number < kHalves; ++number) {
        const auto half = std::make_unique<HalfTile>(film, V2i(tile.x0, tile.y0), number);
        const auto pilot = std::make_unique<PilotTile>(pilots, tile, number);
        const WindowWeights weights({pilot->colour, pilot->variance, half->inside, kOfPilots});
        const FirstEstimates read(out, pilots, tile, number);
        EstimateWriter writer(out, number);
        each_eight_of(tile, [&](int x, int y, int count) {
            const Regression regression(*half, weights, kSecond, x, y);
            const Colour8 first = read.colour(x, y, count);
            Colour8 second = regression.colour().mean;
            const f8 way = way_to_second(first, read.deviation(x, y, count), second);
            for (size_t c = 0; c < 3; ++c) second[c] = (1.f - way) * first[c] + way * second[c];
            if (!bins.empty()) regression.estimate(half->bins, bins.data());
            for (size_t b = 0; b < bins.size(); ++b)
                bins[b] = (1.f - way) * read.bin(x, y, count, b) + way * bins[b];
            writer.write(1, tile.x0 + x, tile.y0 + y, count, second, bins);
        });
    }
}

}  // namespace petzval::integrator
