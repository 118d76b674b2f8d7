// SPDX-License-Identifier: Apache-2.0
// Region of the stop whose rays pass a target, for one film point and wavelength.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "camera/target.h"
#include "camera/targets/stop_map.h"

namespace petzval::camera {

/// Landings on a target, in its radii, as polynomials of the point of the stop: as StopMap::Rays.
struct LandingMap {
    std::array<float, StopMap::kTerms> x, y;

    LandingMap(const StopMap::Rays&, const ListedTarget&);
};

/// Eight landings with their derivatives by the point of the stop.
struct Landings {
    f8 x, y, x_by_s, y_by_s, x_by_t, y_by_t;

    /// Curvature by the change of the derivatives between the quarters of two squares, four lanes
    /// each: left and right below, left and right above, so far apart.
    [[nodiscard]] f8 curvature(float apart) const {
        const f8 beside = change2(u32x8{1, 0, 3, 2, 5, 4, 7, 6}),
                 above = change2(u32x8{2, 3, 0, 1, 6, 7, 4, 5}),
                 across = change2(u32x8{3, 2, 1, 0, 7, 6, 5, 4});
        return sqrt(max(max(beside, above), across / 2)) / apart;
    }
    /// Whether a straight landing may come as near to the target as that in squares about the
    /// points: by the largest stretch, and across the longer one of the derivatives.
    [[nodiscard]] m8 may_be_near(float half, f8 wide) const {
        const f8 s2 = x_by_s * x_by_s + y_by_s * y_by_s, t2 = x_by_t * x_by_t + y_by_t * y_by_t,
                 det = abs(x_by_s * y_by_t - x_by_t * y_by_s);
        const f8 long_x = s2 > t2 ? x_by_s : x_by_t, long_y = s2 > t2 ? y_by_s : y_by_t;
        const f8 across = long_x * y - long_y * x, more = half * det,
                 most = wide + stretch()[0] * (1.41421356f * half);
        const f8 left = max(f8{}, abs(across) - more);
        return (x * x + y * y <= most * most) & (left * left <= wide * wide * max(s2, t2));
    }
    /// Largest and least stretch: singular values of the derivatives.
    [[nodiscard]] std::array<f8, 2> stretch() const {
        const f8 half = (x_by_s * x_by_s + y_by_s * y_by_s + x_by_t * x_by_t + y_by_t * y_by_t) / 2,
                 det = abs(x_by_s * y_by_t - x_by_t * y_by_s);
        const f8 most = sqrt(half + sqrt(max(f8{}, half * half - det * det)));
        return {most, det / most};
    }

  private:
    [[nodiscard]] f8 change2(u32x8 lane) const {
        const auto change = [&](f8 a) { return a - __builtin_shuffle(a, (m8)lane); };
        const f8 xs = change(x_by_s), ys = change(y_by_s), xt = change(x_by_t), yt = change(y_by_t);
        return xs * xs + ys * ys + xt * xt + yt * yt;
    }
};
[[nodiscard]] Landings landings(const LandingMap&, f8 s, f8 t);

/// Landing of a ray on a target, in its radii.
[[nodiscard]] V2f landing(const f4& ray, const ListedTarget&);

/// Distance from the middle of a target, in its radii, that counts as on it once the lens itself
/// was asked: for what changes nearby.
inline constexpr float kCorrectedReach = 1.03f;

/// Change of a landing, in radii, by the film point, for the width and the height of the frame.
struct FilmMotion {
    V2f right, down;

    /// by_film: derivatives of the rays by the film point.
    FilmMotion(const std::array<StopMap::Rays, 2>& by_film, const ListedTarget&, V2f stop);
    /// Change of the film point that changes the landing by so much.
    [[nodiscard]] V2f film_for(V2f landing) const;
    /// Area on the target for the whole frame, radii^2.
    [[nodiscard]] float area() const { return std::fabs(Linear2f{right, down}.determinant()); }
};

/// Ellipses and rectangles on the disc of a map that cover all points whose rays pass a target, as
/// the map has them. Each way on which light gets there has an ellipse, by Newton's method; where
/// ways meet (at a caustic) there are strips. They may overlap, and may reach beyond the disc.
class StopRegion {
  public:
    /// The rays are those of a film point by the map. wider: distance in radii from the target that
    /// counts as on it, too.
    StopRegion(const StopMap&, const StopMap::Rays&, const ListedTarget&, float wider = 0);

    /// Few shapes of those that there is room for are there, as a rule.
    StopRegion(const StopRegion& o) { *this = o; }
    StopRegion& operator=(const StopRegion& o) {
        std::copy_n(o.shapes_.begin(), o.count_, shapes_.begin());
        count_ = o.count_, areas_ = o.areas_, is_whole_ = o.is_whole_, squares_ = o.squares_;
        evaluations_ = o.evaluations_;
        return *this;
    }
    [[nodiscard]] bool empty() const { return count_ == 0; }
    /// Area of all together, overlaps as often as they are covered; the unit disc has pi.
    [[nodiscard]] float area() const { return areas_[0] + areas_[1]; }
    /// Draws a point, with the density of density(); pick in [0, 1), on in [0, 1)^2.
    [[nodiscard]] V2f sample(float pick, V2f on) const;
    /// Squares of the map that may hold a point of the region, by bits.
    [[nodiscard]] uint64_t squares() const { return squares_; }
    /// How often the map was asked, eight points at a time: what the search took.
    [[nodiscard]] uint32_t evaluations() const { return evaluations_; }
    /// Number of the shapes, and whether one is an ellipse: a way, of which the middle is known.
    [[nodiscard]] size_t size() const { return count_; }
    [[nodiscard]] bool is_ellipse(size_t shape) const { return !shapes_[shape].is_square; }
    [[nodiscard]] V2f middle(size_t shape) const { return shapes_[shape].middle; }
    /// Corrects an ellipse by the landing of its middle, in radii, as the lens itself has it: what
    /// is not known of the map then counts no more.
    void correct(size_t ellipse, V2f landing);
    /// Density of a point: its covers over their area, half of ellipses and half of strips where
    /// there are both. (Strips may be large beside what they hold: by area alone, ellipses would be
    /// drawn too seldom.)
    [[nodiscard]] float density(V2f s) const;

  private:
    /// Image of the unit disc or of the square from -1 to 1.
    struct Shape {
        V2f middle, by_x, by_y;
        float area;
        bool is_square;
        float reach;  ///< of an ellipse: landing at its rim, in radii
        /// Of an ellipse: what a landing is off from a straight one, in radii, a radius from the
        /// middle.
        float bent = 0;

        [[nodiscard]] bool contains(V2f) const;
    };
    struct Eight;
    class Squares;
    struct LeftSquare {
        V2f middle;
        Shape strip;  ///< no area: it must be divided
    };
    static constexpr size_t kMost = 256;
    [[nodiscard]] static Shape strip(V2f middle, float half, const Landings&, int, float wide);
    void add(const Shape&);
    /// Chance that a draw goes to ellipses, or to squares.
    [[nodiscard]] float chance(bool is_square) const {
        return !(areas_[is_square] > 0) ? 0.f : areas_[!is_square] > 0 ? 0.5f : 1.f;
    }
    [[nodiscard]] size_t find(const LandingMap&, const Eight&, float half, LeftSquare* left);
    [[nodiscard]] bool is_covered(V2f middle, float half, size_t by_first) const;
    [[nodiscard]] bool add_ellipse(const LandingMap&, V2f s, const Landings&, int lane, float reach,
                                   float curvature);
    [[nodiscard]] bool is_around(const LandingMap&, const Shape& ellipse, float reach);

    std::array<Shape, kMost> shapes_;
    size_t count_ = 0;
    std::array<float, 2> areas_{};  ///< of ellipses and of squares
    bool is_whole_ = false;
    uint64_t squares_ = 0;
    uint32_t evaluations_ = 0;
};

/// Distance in radii within which the landing of a ray by the map may be one on the target; 0 where
/// no ray of the cell comes near it.
[[nodiscard]] inline float reach_at(const StopMap& map, const ListedTarget& target, V2f stop) {
    const size_t n = StopMap::square(stop);
    return target.squares >> n & 1 ? 1 + target.in_radii(map.error(n)) : 0;
}

}  // namespace petzval::camera
