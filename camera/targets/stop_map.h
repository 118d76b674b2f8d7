// SPDX-License-Identifier: Apache-2.0
// Map of a cell: where the rays of its film points go, by the point of the stop that they cross.
#pragma once

#include <algorithm>
#include <array>
#include <memory>

#include "camera/film_cell.h"
#include "camera/target.h"
#include "camera/targets/stop_camera.h"

namespace petzval::camera {

/// Polynomials, by least squares, of the rays of a cell: of degree 9 in the point of the stop, 2
/// in the film point and 3 in the wavelength. (Polynomials of a lens: Hullin, Hanika and
/// Heidrich 2012, "Polynomial Optics".)
///
/// Its frame looks along a ray from the middle of the cell. A ray has two places, metres, where it
/// crosses the plane through the frame's origin, and two slopes against its axis. Points of the
/// stop count on a disc of radius 1, which is the ellipse about those that rims leave.
class StopMap {
  public:
    static constexpr int kDegree = 9;
    static constexpr size_t kTerms = (kDegree + 1) * (kDegree + 2) / 2;
    /// Rays of one film point and wavelength: for each power of y from 0 on, coefficients of the
    /// powers of x. Lanes: places right and up, slopes right and up.
    using Rays = std::array<f4, kTerms>;

    /// Map of a cell of the film; nullptr where too few points of the stop are met by its rays.
    [[nodiscard]] static std::shared_ptr<const StopMap> of(const StopCamera&, const FilmCell&);

    [[nodiscard]] Rays rays(V2f film, float nm) const;
    /// Derivatives of rays() by the film point, right and down.
    [[nodiscard]] std::array<Rays, 2> rays_by_film(V2f film) const;
    /// Point of the camera's space, metres, in the frame: right, up, ahead.
    [[nodiscard]] V3d local(const V3d& point_m) const { return turned(point_m - origin_m_); }
    /// The same of a direction.
    [[nodiscard]] V3d turned(const V3d& d) const {
        return {d.dot(right_), d.dot(up_), d.dot(axis_)};
    }
    /// Places and slopes of a ray, as the polynomials have them.
    [[nodiscard]] std::array<double, 4> parts(const StopRay&) const;
    /// Point of the disc for one of the stop, and the other way round.
    [[nodiscard]] V2f on_disc(V2f stop_mm) const {
        const V2f off = stop_mm - stop_mm_;
        return V2f(off.dot(long_axis_) / half_mm_.x, off.dot(short_axis()) / half_mm_.y);
    }
    [[nodiscard]] V2f stop_mm(V2f on_disc) const {
        return stop_mm_ + long_axis_ * (on_disc.x * half_mm_.x) +
               short_axis() * (on_disc.y * half_mm_.y);
    }
    /// Area of the stop for a unit of the disc.
    [[nodiscard]] float stretch_mm2() const { return half_mm_.x * half_mm_.y; }
    /// Squares side by side about the disc, of which each has bounds of its own.
    static constexpr int kSquares = 8;
    static constexpr size_t kSquares2 = size_t{kSquares} * kSquares;
    /// Number of the square of a point of the disc; beyond all, that of the nearest.
    [[nodiscard]] static size_t square(V2f on_disc) {
        const auto cell = [](float a) {
            return static_cast<size_t>(std::clamp((a + 1) * (kSquares / 2.f), 0.f, kSquares - 1.f));
        };
        return cell(on_disc.y) * kSquares + cell(on_disc.x);
    }
    [[nodiscard]] static V2f middle_of(size_t square) {
        return V2f(float(2 * (square % kSquares) + 1), float(2 * (square / kSquares) + 1)) /
                   float(kSquares) -
               V2f(1.f);
    }
    /// Squares that hold a part of the disc, by bits: all but the four corners.
    static constexpr uint64_t kOnDisc = 0x7effffffffffff7e;
    /// Bounds in a square, of a place and of a slope: errors; and second derivatives by the point
    /// of the disc.
    [[nodiscard]] V2f error(size_t square) const { return error_[square]; }
    [[nodiscard]] V2f bend(size_t square) const { return bend_[square]; }
    /// Wavelengths that stand for all, nm: beyond these little is seen.
    static constexpr std::array<float, 3> kTried_nm{410, kMiddle_nm, 700};
    /// Largest changes of a place and of a slope from the middle of the cell, at line d, to its
    /// corners, at any wavelength.
    [[nodiscard]] V2f moves() const { return moves_; }
    /// Largest slope that was met.
    [[nodiscard]] float most_slope() const { return most_slope_; }
    /// Film point in the middle of the cell, and half its size.
    [[nodiscard]] V2f middle() const { return middle_; }
    [[nodiscard]] V2f half() const { return half_; }

  private:
    static constexpr size_t kPlaces = 9;  ///< terms of film point and wavelength
    using Weights = std::array<float, kPlaces>;
    [[nodiscard]] Rays weighed(const Weights&) const;
    [[nodiscard]] static Weights weights(V2f in_cell, float wave);

    [[nodiscard]] V2f short_axis() const { return {-long_axis_.y, long_axis_.x}; }
    void find_ellipse(const StopCamera&);
    void find_bounds();

    V2f stop_mm_{0.f}, long_axis_{1, 0}, half_mm_{0.f};
    V3d origin_m_, right_, up_, axis_;
    V2f middle_, half_;
    std::array<V2f, kSquares2> error_{}, bend_{};
    V2f moves_{0.f};
    float most_slope_ = 0;
    std::array<std::array<f4, kPlaces>, kTerms> terms_{};
};

/// A ray of a polynomial at a point of the stop.
[[nodiscard]] f4 at(const StopMap::Rays&, V2f stop);

}  // namespace petzval::camera
