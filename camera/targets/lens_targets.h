// SPDX-License-Identifier: Apache-2.0
// Rays of a traced lens to targets: found by Newton's method through all surfaces, and the density
// with which they are drawn. Millimetres, in the lens's own space.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "camera/lens/direction_search.h"
#include "camera/lens/ray_aiming.h"
#include "camera/target.h"
#include "core/sampling/sampler.h"

namespace petzval {

/// Film points of eight rays at their wavelengths, and the targets of each; a lane without targets
/// counts for nothing.
struct TargetPoints {
    PlanePoint<f8> film_mm;
    const LensIndices<f8>& indices;
    std::array<TargetList, 8> targets;
};

/// The target of each of eight rays, the point on its disc, and what picks one of its ways.
struct TargetChoice {
    std::array<int, 8> target;  ///< -1: none
    f8 x{}, y{};                ///< in radii
    f8 way{};                   ///< [0, 1)

    TargetChoice() { target.fill(-1); }
};

class LensTargets {
  public:
    /// Lens and aimer must outlive it. pupil_mm: z of the middle of the entrance pupil, which is
    /// the origin of the targets' space. stop_reach_mm: radius of the iris.
    LensTargets(const Lens&, const RayAimer&, double pupil_mm, double stop_reach_mm,
                double iris_mm2);

    /// The target with starts from all over the stop, each for the film point that sees the target
    /// through that point of the stop. The place is in mm. Nothing where none is found near a film
    /// of so many mm from the middle to its edges.
    [[nodiscard]] std::optional<PreparedTarget> prepared(const LocalTarget&,
                                                         V2f half_film_mm) const;
    /// The target with those starts that lead to it by ways of their own from a cell; nothing where
    /// none does from a place of the cell. Without its place on the film.
    [[nodiscard]] std::optional<ListedTarget> listed(const PreparedTarget&, V2f place_mm,
                                                     const FilmCell& cell_mm) const;
    /// Draws a target for each lane and a point on its disc.
    [[nodiscard]] static TargetChoice choose(const std::array<TargetList, 8>&,
                                             std::span<const Sampler>);
    /// Directions at the film whose rays pass the chosen points. Where several ways lead there,
    /// each is picked in proportion to the light that it brings.
    [[nodiscard]] FoundDirections find(const TargetPoints&, const TargetChoice&) const;
    /// Density with which choose() and find() draw a direction, 1/sr of projected solid angle at
    /// the film: a sum over all targets that its ray passes, if find() would find this very ray.
    [[nodiscard]] f8 density(const TargetPoints&, f8 l, f8 m) const;

  private:
    /// Directions this far apart are the same, in units of what the stop spans; a search may leave
    /// a third of it.
    static constexpr float kSame = 3e-3f;

    struct Goals;
    struct Guess;
    struct Landing;
    struct Ways;
    [[nodiscard]] Goals goals(const std::array<TargetList, 8>&,
                              const std::array<int, 8>& which) const;
    /// Rays that pass the points `on` of targets, in radii, from guesses of their directions.
    [[nodiscard]] FoundDirections search(const TargetPoints&, const Goals&, m8 wanted,
                                         const PlanePoint<f8>& on, const Guess&, Landing&) const;
    [[nodiscard]] Ways ways(const TargetPoints&, const Goals&, m8 wanted, f8 x, f8 y) const;
    /// Whether directions that are so far apart are the same.
    [[nodiscard]] m8 same(f8 l, f8 m) const { return l * l + m * m < sqr(kSame * cosine_reach_); }
    [[nodiscard]] LensRay<Dual<f8>> trace(const TargetPoints&, f8 l, f8 m) const;
    struct Pictured;
    [[nodiscard]] Pictured pictured(const Goals&, const LensIndices<f8>&,
                                    const PlanePoint<f8>& stop_mm, const PlanePoint<f8>& from_mm,
                                    int steps) const;
    [[nodiscard]] PlanePoint<f8> spread(int first) const;
    struct WayFrom;
    void add_ways(std::vector<WayFrom>&, V2f place_mm, const Goals&, const LensIndices<f8>&,
                  std::span<const TargetStart* const>, size_t from) const;
    [[nodiscard]] std::array<TargetStart, 8> starts_at(const TargetPoints&, const Goals&, f8 l,
                                                       f8 m) const;

    const Lens& lens_;
    const RayAimer& aimer_;
    double pupil_mm_, stop_reach_mm_, iris_mm2_;
    /// Direction cosine from the axis to the rim of the stop, about: what directions are apart is
    /// large or small against it.
    float cosine_reach_;
};

}  // namespace petzval
