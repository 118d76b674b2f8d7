// SPDX-License-Identifier: Apache-2.0
// Edges of a pupil, and the light that they send far from the image point: the spikes of a star.
#pragma once

#include <span>
#include <vector>

#include "core/math/math.h"

namespace petzval::camera {

/// Part of a pupil's edge without a corner, straight or curved.
struct EdgeRun {
    double length = 0;
    double normal_rad = 0;  ///< direction across the edge, in its middle
    double turn_rad = 0;    ///< by how much that direction turns from one end to the other
};

/// Runs of closed contours. Where the direction turns by more than 6 degrees there is a corner.
[[nodiscard]] std::vector<EdgeRun> edge_runs(std::span<const std::vector<V2d>> contours);

/// Share of the light of a wrapped Lorentz (Cauchy) curve from its middle to an angle within half a
/// turn; tanh_half: tanh of half its width.
[[nodiscard]] float light_up_to(float angle, float tanh_half);

/// Far part of the diffraction pattern of an even pupil, beyond a radius of the plane of spatial
/// frequencies v. An edge of length l adds l^2 sinc^2(l s) / (2 pi r)^2 at v, whose parts across
/// and along it are r and s (Fourier transform of a polygon: Lee and Mittra 1983, IEEE Trans.
/// Antennas Propag. 31, 99); here the fringes are averaged: those of sinc^2 to the Lorentz curve
/// that has the same wings, and those between edges to nothing. What is left is drawn exactly.
class FarPattern {
  public:
    FarPattern() = default;
    /// even_length: length of edges of which only that is known; all directions alike.
    FarPattern(std::vector<EdgeRun> runs, double even_length, double radius);

    /// Point of the plane, u in [0, 1)^2 and pick in [0, 1).
    [[nodiscard]] V2f draw(float pick, V2f u) const;
    /// Density of draw() at a point; 0 within the radius.
    [[nodiscard]] float density(V2f v) const;
    [[nodiscard]] float radius() const { return radius_; }

    /// Light to one side of an edge.
    struct Lobe {
        V2f normal;
        float share, up_to;  ///< of the draws, and the sum with those before
        float turn, angle;
        float width;  ///< of the Lorentz curve: half of it at half its height

        [[nodiscard]] bool is_straight() const { return turn < 1e-4f; }
        /// Density by direction, per radian, at a distance from the middle.
        [[nodiscard]] float per_radian(V2f direction, float radius) const;
    };
    [[nodiscard]] std::span<const Lobe> lobes() const { return lobes_; }
    /// Share of the draws that go to all directions alike.
    [[nodiscard]] float even_share() const { return even_; }

  private:
    std::vector<Lobe> lobes_;
    float even_ = 1, radius_ = 1;
};

}  // namespace petzval::camera
