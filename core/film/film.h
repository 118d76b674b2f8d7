// SPDX-License-Identifier: Apache-2.0
// Film: exact sums of the samples of each pixel, so that neither their order nor their grouping
// changes a bit.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/film/aov.h"
#include "core/film/exact_sum.h"
#include "core/film/film_blocks.h"
#include "core/film/film_halves.h"
#include "core/film/sample_range.h"
#include "core/film/spectral_film.h"
#include "core/math/ray.h"
#include "core/spectrum/bands.h"

namespace petzval {

/// Half-open rectangle of pixels.
struct Rect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    [[nodiscard]] int width() const { return x1 - x0; }
    [[nodiscard]] int height() const { return y1 - y0; }
    bool operator==(const Rect&) const = default;
};

/// One finished sample of a pixel.
struct FilmSample {
    Rgb colour;
    float alpha = 0.f;
    bool hit = false;                                      ///< the layers below hold something
    Hit first{};                                           ///< of the surface that they are of
    std::array<V3f, static_cast<size_t>(Aov::Count)> aov;  ///< unset where nothing was hit
    Guide guide{};                                         ///< of a film with halves
};

/// What a film keeps beside its sums.
struct FilmKeeps {
    bool blocks = false;  ///< what tells the noise
    bool halves = false;  ///< what a denoiser needs
    bool operator==(const FilmKeeps&) const = default;
};

class Film {
  public:
    /// crop: the part of a full frame that is kept; pixels are named by full-frame coordinates.
    /// bins: keep a spectral film beside RGB.
    Film(V2i full_size, Rect crop, std::vector<Aov> aovs, std::optional<Bins> bins = {},
         FilmKeeps keeps = {});

    /// Memory that a film takes for each pixel that it has.
    [[nodiscard]] static size_t bytes_per_pixel(size_t layers, const std::optional<Bins>&,
                                                FilmKeeps = {});
    /// Pixels that a film has: its crop, and what a denoiser needs around it.
    [[nodiscard]] static Rect pixels_for(const Rect& crop, V2i full_size, FilmKeeps);

    /// Adds a sample. One that is not finite, or too large for the sums (exact_sum.h), is only
    /// counted, and the first such is remembered.
    void add(int x, int y, uint32_t index, const FilmSample&);
    /// Adds a sample to a film with bins.
    void add(int x, int y, uint32_t index, const FilmSample&, const SpectralFilm::Sample&,
             const Bands&);

    /// Writes what the film has of a pixel, as bytes_per_pixel() bytes.
    void pack(int x, int y, uint8_t* to) const;
    /// Adds to a pixel what pack() wrote of other samples of it, on a film with the same layers and
    /// bins.
    void add_packed(int x, int y, const uint8_t* from);

    /// Number of samples, of this range of indices, in what pack() wrote of a pixel of a film with
    /// these layers and bins; nothing where no film has such sums and counts.
    [[nodiscard]] static std::optional<uint32_t> packed_count(const uint8_t* from,
                                                              std::span<const Aov> layers,
                                                              const std::optional<Bins>&, FilmKeeps,
                                                              SampleRange);

    [[nodiscard]] V2i full_size() const { return full_size_; }
    [[nodiscard]] Rect crop() const { return crop_; }
    /// Pixels that are there: the crop, and with halves some around it.
    [[nodiscard]] Rect pixels() const { return kept_; }
    [[nodiscard]] FilmKeeps keeps() const { return {blocks_.has_value(), halves_.has_value()}; }
    /// Means of a half of a pixel of a film with halves.
    [[nodiscard]] FilmHalves::Half half(int x, int y, uint32_t half) const {
        return halves_->half(offset(x, y), half);
    }
    [[nodiscard]] const std::vector<Aov>& aovs() const { return aovs_; }
    /// Spectral sums: bins, XYZ and errors; nothing unless the film was made with bins.
    [[nodiscard]] const std::optional<SpectralFilm>& spectral() const { return spectral_; }
    /// Closes a block of a pixel (film_blocks.h).
    void close_block(int x, int y) { blocks_->close(offset(x, y), mean(x, y)); }
    /// Parts of a pixel of a film with blocks.
    [[nodiscard]] FilmBlocks::Parts parts(int x, int y) const {
        return blocks_->parts(offset(x, y), taken_count(x, y), mean(x, y));
    }
    /// Index in spectral() of a pixel.
    [[nodiscard]] size_t offset(int x, int y) const {
        return static_cast<size_t>(y - kept_.y0) * kept_.width() + (x - kept_.x0);
    }
    [[nodiscard]] uint32_t sample_count(int x, int y) const { return pixel(x, y).count; }
    /// Number of samples of a pixel that were left out.
    [[nodiscard]] uint32_t left_out(int x, int y) const { return pixel(x, y).left_out; }
    /// Fewest and most samples that a pixel has been given.
    struct TakenRange {
        uint32_t least, most;
    };
    [[nodiscard]] TakenRange taken_range() const;
    /// Number of samples of all pixels that were given to add().
    [[nodiscard]] uint64_t taken_count() const;
    /// Number of samples of a pixel that were given to add().
    [[nodiscard]] uint32_t taken_count(int x, int y) const {
        return pixel(x, y).count + pixel(x, y).left_out;
    }
    /// Mean linear RGB in nits, and alpha; zero where there is no sample.
    [[nodiscard]] V4f colour(int x, int y) const;
    /// Mean of a layer over the samples that hit something, of ghosts over all; zero without such.
    [[nodiscard]] V3f aov(int x, int y, size_t layer) const;

    /// Samples that were left out, and the first of them in scan order, of either kind.
    struct LeftOut {
        uint64_t not_finite = 0, too_large = 0;
        int x = 0, y = 0;
        uint32_t index = 0;
        [[nodiscard]] uint64_t count() const { return not_finite + too_large; }
    };
    [[nodiscard]] LeftOut left_out() const;

  private:
    struct Pixel {
        std::array<FilmSum, 4> sum{};
        uint32_t count = 0, hits = 0, left_out = 0, first_left_out = 0;
    };
    void accept(Pixel&, size_t at, uint32_t index, const FilmSample&);
    [[nodiscard]] V3f mean(int x, int y) const {
        const V4f c = colour(x, y);
        return {c.x, c.y, c.z};
    }
    void reject(size_t at, uint32_t index, bool finite);
    template <class Test>
    [[nodiscard]] bool each_number(const FilmSample&, const Test&) const;
    [[nodiscard]] const Pixel& pixel(int x, int y) const { return pixels_[offset(x, y)]; }

    V2i full_size_;
    Rect crop_, kept_;
    std::vector<Aov> aovs_;
    std::vector<Pixel> pixels_;
    std::vector<uint32_t>
        too_large_;  ///< of those that a pixel left out; in Pixel it would take 16 bytes
    std::vector<std::array<FilmSum, 3>> aov_sums_;  ///< pixel-major
    std::optional<SpectralFilm> spectral_;
    std::optional<FilmBlocks> blocks_;
    std::optional<FilmHalves> halves_;
};

}  // namespace petzval
