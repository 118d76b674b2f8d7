// SPDX-License-Identifier: Apache-2.0
// Light that a pilot met too seldom to know it: lamps so small that few camera rays meet them, and
// lamps behind mirrors and glass, which paths find by chance.
#pragma once

#include <cstdint>
#include <vector>

#include "apps/plan/pilot_error.h"
#include "camera/setup/film_region.h"
#include "core/light/small_features.h"

namespace petzval::apps {

/// Paths from which on noise counts as known.
inline constexpr double kEnoughPaths = 16;

/// A lamp that the film sees through the camera itself.
struct SeenLamp {
    int64_t area_px;     ///< of the film that its light falls on
    double probability;  ///< that a camera ray of this area meets it
    bool alone;          ///< its light is even over the area: one lamp, not several far apart
    SmallFeature feature;
    const camera::FilmRegion* region;

    /// Variance of one sample that it adds where nothing else does, times the squared mean.
    [[nodiscard]] double square() const {
        return feature.radiance * feature.radiance * probability;
    }
};

/// Small features of a scene; lamps that are targets one by one.
[[nodiscard]] std::vector<SmallFeature> features_of(const RenderSetup&);

/// Lamps among the things that no surface hides from the camera, each with its region.
[[nodiscard]] std::vector<SeenLamp> seen_lamps(const RenderSetup&, V2i size_px,
                                               const std::vector<SmallFeature>&,
                                               const std::vector<camera::FilmRegion>&);

/// Least means of a pilot's pixels, as PilotScale wants them: where a lamp is met by less than one
/// sample of a pilot pixel, the mean over all pilot pixels at its disc, or what the lamp is
/// expected to bring; 0 elsewhere. Lamps count as white.
[[nodiscard]] std::vector<V3d> least_means(const Pilot&, const PilotModel&,
                                           const std::vector<SeenLamp>&);

/// A lamp, and the samples of each pixel with which kEnoughPaths paths meet it, by the camera
/// alone: those that it draws and those that it sends there.
struct LampSamples {
    SeenLamp lamp;  ///< its region is the next member
    camera::FilmRegion region;
    double samples;
};
/// Lamps of at least so many nits that no surface hides from the camera.
[[nodiscard]] std::vector<LampSamples> samples_of_lamps(const RenderSetup&, V2i size_px,
                                                        double nits);

/// Some lamps, and spots of the sky.
struct SmallLamps {
    size_t lamps = 0, spots = 0;
    double largest_lamp_m = 0, largest_spot_rad = 0;
    double samples = 0;  ///< of each pixel with which enough paths meet all, where it is known

    void add(const SeenLamp&);
    [[nodiscard]] size_t count() const { return lamps + spots; }
};

/// Lamps that fewer than kEnoughPaths paths of a frame meet, by the camera alone. A lamp counts
/// where one path makes a pixel brighter by at least so many nits, of so many samples.
[[nodiscard]] SmallLamps seldom_met(const RenderSetup&, V2i size_px, double samples, double nits);

/// Light that a pilot of a model cannot know.
struct RareLight {
    SmallLamps seldom;  ///< seen ones that fewer than kEnoughPaths paths will have met
    double noise = 0;   ///< symmetric variance of one sample that they would add
    double lost = 0;    ///< symmetric MSE of a picture without them
    /// Lamps that rays are sent to, and would seldom be met without, and the variance of one sample
    /// that they would add then.
    size_t targeted = 0;
    double spared = 0;
    /// Smooth surfaces were met, and behind them fewer than kEnoughPaths paths met a lamp.
    bool mirrored = false, caustic = false;
    /// Lights that no path finds, or hardly one (PreparedScene::lost_light).
    size_t behind_glass = 0;

    [[nodiscard]] bool by_chance() const { return mirrored || caustic || behind_glass > 0; }
};
[[nodiscard]] RareLight rare_light(const Pilot&, const PilotModel&, const std::vector<SeenLamp>&,
                                   bool has_lamps, double floor);

}  // namespace petzval::apps
