// SPDX-License-Identifier: Apache-2.0
// Iris of a camera: a shape, scaled to its stop, that is sampled and asked for its transmission.
#pragma once

#include <limits>
#include <numbers>
#include <optional>
#include <variant>

#include "camera/iris/iris_mask.h"
#include "camera/iris/iris_options.h"
#include "camera/iris/iris_polygon.h"

namespace petzval::camera {

/// Sampling methods that a shape has; the first keeps stratification best. Circle and mask have no
/// triangles, other polygons no formula.
[[nodiscard]] std::vector<IrisSampling> iris_samplings(const ApertureShape&);

/// Iris in the plane of the stop. Coordinates as in aperture.h, in millimetres.
class Iris {
  public:
    /// Samples by the first of iris_samplings() where none is named. Throws std::invalid_argument
    /// for a radius beyond kMinStopRadius_mm to kMaxStopRadius_mm, for a shape with a fault, and
    /// for a way of sampling that the shape does not have.
    /// rim_radius_mm: what of the shape lies beyond is cut off, so that no point is drawn there; a
    /// shape that would lose nine tenths is left whole.
    Iris(const ApertureShape&, double stop_radius_mm, ApertureScale = ApertureScale::EqualArea,
         std::optional<IrisSampling> = {},
         double rim_radius_mm = std::numeric_limits<double>::infinity());

    /// Draws a point of the shape within the rim; a pure function of u in [0, 1)^2. Its place is
    /// rounded, so that one at the very edge may not be inside. Rejection takes u first and then up
    /// to kTries - 1 hashes of it; when none is inside, a further hash is drawn by the other ways.
    [[nodiscard]] V2f sample(V2f u) const;
    /// Transmission at a point: 0 or 1, for a mask what its texel says; 0 for NaN.
    [[nodiscard]] float transmits(V2f point_mm) const {
        if (cut_ && !within_rim(point_mm)) return 0.f;
        return std::visit([&](const auto& shape) { return shape.transmits(point_mm); }, shape_);
    }
    /// Integral of transmits() over the plane.
    [[nodiscard]] double area_mm2() const { return area_; }
    /// Distance of the shape's farthest point from the axis.
    [[nodiscard]] float bounding_radius_mm() const { return static_cast<float>(reach_); }
    /// Contours about what it lets through, the rim left out; none of a mask.
    [[nodiscard]] std::vector<std::vector<V2d>> outline_mm() const;
    /// Share of area_mm2() that lies farther than this from the axis. In closed form, error below
    /// 1e-9.
    [[nodiscard]] double share_beyond(double radius_mm) const;
    /// Share of the whole shape's light that the rim takes away.
    [[nodiscard]] double share_cut() const { return share_cut_; }

    static constexpr int kTries = 256;
    /// Range of stop radii, so that areas are floats above 0.
    static constexpr double kMinStopRadius_mm = 1e-9;
    static constexpr double kMaxStopRadius_mm = 1e6;

  private:
    struct Round {
        double radius_mm;
        float radius;
        [[nodiscard]] V2f draw(V2f u) const;
        [[nodiscard]] float transmits(V2f p) const { return p.dot(p) <= sqr(radius) ? 1.f : 0.f; }
        [[nodiscard]] float peak() const { return 1.f; }
        [[nodiscard]] V2f lower() const { return V2f(-radius); }
        [[nodiscard]] V2f size() const { return V2f(2 * radius); }
        [[nodiscard]] double area_mm2() const { return std::numbers::pi * radius_mm * radius_mm; }
        [[nodiscard]] double area_within_mm2(double r) const { return std::numbers::pi * r * r; }
    };
    using Shape = std::variant<Round, PolygonIris, MaskIris>;

    [[nodiscard]] static Shape scaled(const ApertureShape&, double mm, IrisSampling);
    template <class Drawn>
    [[nodiscard]] static V2f reject(const Drawn&, V2f u);
    [[nodiscard]] bool within_rim(V2f p) const { return p.dot(p) <= rim2_mm2_; }
    [[nodiscard]] V2f sample_whole(V2f u) const;

    bool rejection_, cut_ = false;
    float rim2_mm2_ = 0;
    double reach_, area_, share_cut_ = 0;
    Shape shape_;
};

}  // namespace petzval::camera
