// SPDX-License-Identifier: Apache-2.0
// Polygon iris in millimetres: sampling, and a test for which points are inside.
#pragma once

#include <span>

#include "camera/iris/trapezoids.h"
#include "core/sampling/alias_table.h"
#include "core/sampling/distribution.h"
#include "core/sampling/warp.h"

namespace petzval::camera {

/// Point-in-polygon test: a raster of cells that are inside, outside, or cut by an edge and then
/// know the trapezoids in them.
class PolygonRaster {
  public:
    PolygonRaster() = default;
    PolygonRaster(const Polygon&, std::span<const Trapezoid>);
    [[nodiscard]] inline bool holds(V2f) const;
    [[nodiscard]] V2f lower() const { return lower_; }
    [[nodiscard]] V2f size() const { return size_; }

  private:
    /// Trapezoid in floats. A side is at low + t * (change), t the share of its height.
    struct Piece {
        float bottom, top, per_height, left, left_change, right, right_change;
        [[nodiscard]] bool holds(V2f p) const {
            const float t = (p.y - bottom) * per_height;
            return p.y >= bottom && p.y < top && p.x >= left + left_change * t &&
                   p.x < right + right_change * t;
        }
    };
    static constexpr int kCells = 64;
    static constexpr uint32_t kOutside = 0, kInside = 1, kFirstList = 2;

    V2f lower_, size_, cells_per_mm_;
    std::vector<uint32_t> cells_;      ///< row by row; from kFirstList on, the number of a list
    std::vector<uint32_t> list_ends_;  ///< list i goes from [i] to [i + 1]
    std::vector<uint32_t> lists_;      ///< indices of pieces
    std::vector<Piece> pieces_;
};

/// Methods to draw points of a polygon: in closed form, or from triangles, of which one is chosen
/// by the running sum of their areas or by an alias table.
enum class PolygonDraw : uint8_t { Formula, RunningSum, Alias };

class PolygonIris {
  public:
    /// The polygon must be without fault, in millimetres. Formula needs has_formula().
    PolygonIris(const Polygon&, PolygonDraw);
    /// Whether there is a closed form: for triangles and parallelograms.
    [[nodiscard]] static bool has_formula(const Polygon&);

    [[nodiscard]] V2f draw(V2f u) const {
        switch (how_) {
            case PolygonDraw::Formula:
                return by_formula(u);
            case PolygonDraw::RunningSum: {
                const Piecewise1D::Draw draw = choice_.sample(u.x);
                return in_triangle(draw.cell, draw.offset, u.y);
            }
            case PolygonDraw::Alias:
                break;
        }
        const AliasTable::Draw draw = aliases_.sample(u.x);
        return in_triangle(draw.cell, draw.offset, u.y);
    }
    [[nodiscard]] float transmits(V2f p) const { return raster_.holds(p) ? 1.f : 0.f; }
    [[nodiscard]] float peak() const { return 1.f; }
    [[nodiscard]] V2f lower() const { return raster_.lower(); }
    [[nodiscard]] V2f size() const { return raster_.size(); }
    [[nodiscard]] double area_mm2() const { return area_; }
    [[nodiscard]] const std::vector<std::vector<V2d>>& contours_mm() const { return contours_mm_; }
    [[nodiscard]] double area_within_mm2(double radius_mm) const;

  private:
    struct Triangle {
        V2f apex, to_first, first_to_second;
    };
    [[nodiscard]] V2f by_formula(V2f u) const {
        if (!parallelogram_) {
            const V2f b = uniform_triangle(u);
            return corner_ + sides_[0] * b.x + sides_[1] * b.y;
        }
        return corner_ + sides_[0] * u.x + sides_[1] * u.y;
    }
    // Point of a triangle. By the running sum u.x rises with the triangles and within each, u.y
    // runs across them: neighbours stay such.
    [[nodiscard]] V2f in_triangle(size_t which, float along, float across) const {
        const Triangle& t = triangles_[which];
        const float root = std::sqrt(across);
        return t.apex + t.to_first * root + t.first_to_second * (root * along);
    }

    PolygonDraw how_;
    bool parallelogram_ = false;
    V2f corner_;
    V2f sides_[2];
    double area_ = 0;
    std::vector<std::vector<V2d>> contours_mm_;
    std::vector<Trapezoid> trapezoids_;
    PolygonRaster raster_;
    std::vector<Triangle> triangles_;
    Piecewise1D choice_;
    AliasTable aliases_;
};

inline bool PolygonRaster::holds(V2f p) const {
    const float x = (p.x - lower_.x) * cells_per_mm_.x, y = (p.y - lower_.y) * cells_per_mm_.y;
    if (!(x >= 0.f && y >= 0.f && x < kCells && y < kCells)) return false;
    const uint32_t cell = cells_[static_cast<uint32_t>(y) * kCells + static_cast<uint32_t>(x)];
    if (cell < kFirstList) return cell == kInside;
    const uint32_t* list = &list_ends_[cell - kFirstList];
    for (uint32_t i = list[0]; i < list[1]; ++i)
        if (pieces_[lists_[i]].holds(p)) return true;
    return false;
}

}  // namespace petzval::camera
