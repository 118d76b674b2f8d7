// SPDX-License-Identifier: Apache-2.0
// Images of lamps on the film and around it, from which the spikes of stars come.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "camera/diffraction/film_spread.h"
#include "camera/target_camera.h"
#include "core/light/small_features.h"

namespace petzval::camera {

/// Places of the film that displaced film points are drawn from, beside those that the patterns
/// draw: where lamps are imaged.
class LampImages {
  public:
    static constexpr size_t kMost = 16;

    LampImages() = default;
    /// Images of the brightest of some small lamps, up to half a frame beyond the edges. aims:
    /// whose targets the lamps may be; nothing is cast into the scene.
    LampImages(const TargetCamera& aims, V2i frame_px, std::span<const SmallFeature> lamps,
               const FilmSpread&);

    [[nodiscard]] bool empty() const { return images_.empty(); }
    /// What lamps bring to film points of a part of the frame, about.
    struct Choice {
        std::array<float, kMost> light{};
        float sum = 0;
        float chance = 0;  ///< that a sample looks for one of them
    };
    [[nodiscard]] const Choice& choice(V2f film) const {
        const auto cell = [](float place, int count) {
            return std::clamp(int(place * float(count)), 0, count - 1);
        };
        return choices_[size_t(cell(film.y, cells_.y) * cells_.x + cell(film.x, cells_.x))];
    }
    /// Place in the image of a lamp, for a film point of these cosines; pick in [0, chance).
    /// Nothing where that lies far beyond the frame.
    [[nodiscard]] std::optional<V2f> draw(const Choice&, const FilmSpread&, V2f cosines, float pick,
                                          V2f u) const;
    /// Density of draw() at a place of these cosines, the chance included, by area of the film.
    [[nodiscard]] float density(const Choice&, V2f cosines, V2f place,
                                const StopCosines::At& there) const;

  private:
    struct Image {
        V2f middle, half;  ///< of a box about it
        float light;       ///< luminance, mean over the box
        SpreadHere spread;
        float disc_radius;  ///< about it in the plane of frequencies
    };
    void find_choices(V2i frame_px, const FilmSpread&);
    void add_lights(V2f film, const FilmSpread&, Choice&) const;

    std::vector<Image> images_;
    V2i cells_{0, 0};
    std::vector<Choice> choices_;  ///< of cells of the frame, row by row
};

}  // namespace petzval::camera
