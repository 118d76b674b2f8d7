// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/denoised_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/spectrum/bands.h"
#include "io/base/format.h"
#include "io/image/symmetric_mse.h"

namespace petzval::apps {
namespace {

// Error about each block. Squares of blocks double until one knows its error well enough; what a
// smaller one knows to be less stays.
std::vector<float> errors_about(const ErrorBlocks& blocks) {
    constexpr double kKnown = 0.6;  // of the square: 30 % of the root
    std::vector<float> out(
        static_cast<size_t>(blocks.across()) * static_cast<size_t>(blocks.down()),
        std::numeric_limits<float>::infinity());
    std::vector<bool> known(out.size());
    const int longest = std::max(blocks.across(), blocks.down());
    const auto look = [&](int side) {
        for (int y = 0; y < blocks.down(); y += side)
            for (int x = 0; x < blocks.across(); x += side) {
                const Rect square{x, y, std::min(x + side, blocks.across()),
                                  std::min(y + side, blocks.down())};
                const DenoisedError error = blocks.over(square);
                const bool knows = error.deviation <= kKnown * error.squared;
                // An estimate below 0 is noise, and not a better bound.
                const double most = std::max(error.squared, 0.) + kDeviations * error.deviation;
                const auto told = static_cast<float>(std::sqrt(knows ? error.squared : most));
                for (int v = square.y0; v < square.y1; ++v)
                    for (int u = square.x0; u < square.x1; ++u) {
                        const auto at = static_cast<size_t>(v * blocks.across() + u);
                        if (!known[at]) out[at] = std::min(out[at], told);
                        known[at] = known[at] || knows;
                    }
            }
    };
    int side = 4;
    for (; side < longest; side *= 2) look(side);
    look(side);
    return out;
}

// Brightness by which the error of a pixel is told.
class Surroundings {
  public:
    explicit Surroundings(const integrator::Denoised& picture)
        : width_(picture.crop.width()),
          height_(picture.crop.height()),
          sums_(static_cast<size_t>(width_ + 1) * static_cast<size_t>(height_ + 1), Imath::V3d(0)) {
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x)
                sum(x + 1, y + 1) =
                    Imath::V3d(
                        picture.colour[static_cast<size_t>(y) * size_t(width_) + size_t(x)]) +
                    sum(x, y + 1) + sum(x + 1, y) - sum(x, y);
    }
    /// Mean over the square about a pixel, as far as it lies in the picture.
    [[nodiscard]] Imath::V3d mean(int x, int y) {
        constexpr int kRadius_px = 3;
        const int x0 = std::max(0, x - kRadius_px), x1 = std::min(width_, x + kRadius_px + 1),
                  y0 = std::max(0, y - kRadius_px), y1 = std::min(height_, y + kRadius_px + 1);
        return (sum(x1, y1) - sum(x0, y1) - sum(x1, y0) + sum(x0, y0)) /
               (double(x1 - x0) * double(y1 - y0));
    }

  private:
    [[nodiscard]] Imath::V3d& sum(int x, int y) {
        return sums_[static_cast<size_t>(y) * static_cast<size_t>(width_ + 1) +
                     static_cast<size_t>(x)];
    }
    int width_, height_;
    std::vector<Imath::V3d> sums_;  ///< of all pixels above and to the left
};

double floor_of(const integrator::Denoised& picture) {
    io::SymmetricFloor floor;
    for (const V3f& c : picture.colour) floor.add(double(luminance({c.x, c.y, c.z})));
    return floor.floor();
}

}  // namespace

std::string text_of(const DenoisedError& error) {
    return error.is_at_most() ? fmt::format("at most {}", io::percent(error.most()))
                              : fmt::format("{} ({} to {})", io::percent(error.value()),
                                            io::percent(error.least()), io::percent(error.most()));
}

std::string text_of(const DenoisedFilm& film) {
    return fmt::format("denoised: error {}, and {} without", text_of(film.error),
                       text_of(film.noisy));
}

std::shared_ptr<const DenoisedFilm> denoised_film(const Film& film,
                                                  integrator::TbbExecutor& executor,
                                                  const std::atomic<bool>& stop) {
    std::optional<integrator::Denoised> picture = integrator::denoise(film, executor, &stop);
    if (!picture) return nullptr;
    auto out = std::make_shared<DenoisedFilm>();
    out->picture = std::move(*picture);
    out->floor_nits = floor_of(out->picture);
    const Rect crop = film.crop();
    ErrorBlocks& denoised = out->blocks = ErrorBlocks(crop.width(), crop.height());
    ErrorBlocks& noisy = out->noisy_blocks = denoised;
    Surroundings surroundings(out->picture);
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) {
            const size_t at = out->picture.offset(x, y);
            const V3f error = out->picture.squared_error[at], doubt = out->picture.doubt[at];
            const auto a = film.half(x, y, 0), b = film.half(x, y, 1);
            const bool has_both = a.count > 0 && b.count > 0;
            const V3f apart = a.colour - b.colour;
            const Imath::V3d bright = surroundings.mean(x - crop.x0, y - crop.y0);
            double squares = 0, noise = 0, variance = 0, doubted = 0;
            for (int c = 0; c < 3; ++c) {
                const double scale =
                    3 * (bright[c] * bright[c] + out->floor_nits * out->floor_nits);
                if (!(scale > 0)) continue;
                squares += double(error[c]) / scale;
                noise += has_both ? double(apart[c]) * double(apart[c]) / (4 * scale)
                                  : double(error[c]) / scale;
                doubted += double(doubt[c]) / scale;
                variance += (double(a.variance[c]) + double(b.variance[c])) / (2 * scale);
            }
            denoised.add(x - crop.x0, y - crop.y0, squares, variance, doubted);
            noisy.add(x - crop.x0, y - crop.y0, noise, 0, 0);
        }
    const Rect all{0, 0, denoised.across(), denoised.down()};
    out->error = denoised.over(all);
    out->noisy = noisy.over(all);
    const std::vector<float> about = errors_about(denoised);
    out->error_about.reserve(out->picture.colour.size());
    for (int y = 0; y < crop.height(); ++y)
        for (int x = 0; x < crop.width(); ++x)
            out->error_about.push_back(about[static_cast<size_t>(
                y / kErrorBlock_px * denoised.across() + x / kErrorBlock_px)]);
    return out;
}

}  // namespace petzval::apps
