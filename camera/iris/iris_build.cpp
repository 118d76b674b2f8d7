// SPDX-License-Identifier: Apache-2.0
#include "camera/iris/iris.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace petzval::camera {
namespace {

template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;  // clang 14 does not find it by itself

// Area and farthest point in a shape's own units; a mask's are texels.
double area_of(const Disk&) {
    return std::numbers::pi;
}
double area_of(const Polygon& polygon) {
    double area = 0;
    for (const Trapezoid& t : trapezoids(polygon)) area += t.area();
    return area;
}
double area_of(const Mask& mask) {
    return std::accumulate(mask.texels.begin(), mask.texels.end(), 0.0);
}

double reach_of(const Disk&) {
    return 1;
}
double reach_of(const Polygon& polygon) {
    double reach = 0;
    for (const auto& contour : polygon.contours)
        for (const V2d& p : contour) reach = std::max(reach, p.length());
    return reach;
}

double reach_of(const Mask& mask) {
    double reach = 0;
    for (int y = 0; y < mask.height; ++y)
        for (int x = 0; x < mask.width; ++x) {
            if (!(mask.texels[static_cast<size_t>(y) * mask.width + x] > 0)) continue;
            const double from_x = std::fabs(x + 0.5 - mask.width / 2.0) + 0.5;
            const double from_y = std::fabs(y + 0.5 - mask.height / 2.0) + 0.5;
            reach = std::max(reach, std::hypot(from_x, from_y));
        }
    return reach;
}

// Largest share of a shape that a rim may cut off: points within it are found by trying.
constexpr double kMostCut = 0.9;

void require_whole(const ApertureShape& shape) {
    if (const auto* polygon = std::get_if<Polygon>(&shape))
        if (const auto fault = find_fault(*polygon)) throw std::invalid_argument(fault->message);
    if (const auto* mask = std::get_if<Mask>(&shape))
        if (const auto fault = find_fault(*mask)) throw std::invalid_argument(*fault);
}

}  // namespace

std::vector<IrisSampling> iris_samplings(const ApertureShape& shape) {
    using enum IrisSampling;
    const auto* polygon = std::get_if<Polygon>(&shape);
    if (!polygon) return {Formula, Rejection};
    if (PolygonIris::has_formula(*polygon)) return {Formula, Triangles, Alias, Rejection};
    return {Triangles, Alias, Rejection};
}

Iris::Shape Iris::scaled(const ApertureShape& shape, double mm, IrisSampling sampling) {
    const auto polygon_of = [&](Polygon polygon) {
        for (auto& contour : polygon.contours)
            for (V2d& p : contour) p *= mm;
        PolygonDraw how = PolygonDraw::RunningSum;
        if (sampling == IrisSampling::Alias)
            how = PolygonDraw::Alias;
        else if (sampling != IrisSampling::Triangles && PolygonIris::has_formula(polygon))
            how = PolygonDraw::Formula;
        return PolygonIris(polygon, how);
    };
    return std::visit(Overloaded{[&](const Disk&) {
                                     return Shape(Round{mm, static_cast<float>(mm)});
                                 },
                                 [&](const Polygon& polygon) { return Shape(polygon_of(polygon)); },
                                 [&](const Mask& mask) { return Shape(MaskIris(mask, mm)); }},
                      shape);
}

Iris::Iris(const ApertureShape& shape, double stop_radius_mm, ApertureScale scale,
           std::optional<IrisSampling> sampling, double rim_radius_mm)
    : rejection_(sampling == IrisSampling::Rejection) {
    if (!(stop_radius_mm >= kMinStopRadius_mm && stop_radius_mm <= kMaxStopRadius_mm))
        throw std::invalid_argument("the stop's radius must be a picometre to a kilometre");
    require_whole(shape);
    const std::vector<IrisSampling> ways = iris_samplings(shape);
    const IrisSampling way = sampling.value_or(ways.front());
    if (std::find(ways.begin(), ways.end(), way) == ways.end())
        throw std::invalid_argument(
            way == IrisSampling::Formula
                ? "there is no formula but for circles, triangles, parallelograms and masks; draw "
                  "from triangles or by rejection"
                : "circles and masks have no triangles; draw by the formula or by rejection");
    const double area = std::visit([](const auto& s) { return area_of(s); }, shape);
    const double reach = std::visit([](const auto& s) { return reach_of(s); }, shape);
    if (!(area > 0)) throw std::invalid_argument("the shape encloses no area");
    const double mm =
        stop_radius_mm *
        (scale == ApertureScale::Inscribed ? 1 / reach : std::sqrt(std::numbers::pi / area));
    shape_ = scaled(shape, mm, way);
    reach_ = mm * reach;
    area_ = std::visit([](const auto& s) { return s.area_mm2(); }, shape_);
    share_cut_ = share_beyond(rim_radius_mm);
    cut_ = share_cut_ > 0 && share_cut_ < kMostCut;
    if (!cut_) return;
    area_ *= 1 - share_cut_;
    reach_ = rim_radius_mm;
    rim2_mm2_ = static_cast<float>(rim_radius_mm * rim_radius_mm);
}

std::vector<std::vector<V2d>> Iris::outline_mm() const {
    constexpr int corners = 720;
    if (const auto* polygon = std::get_if<PolygonIris>(&shape_)) return polygon->contours_mm();
    const auto* round = std::get_if<Round>(&shape_);
    if (!round) return {};
    std::vector<V2d> circle;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners;
        circle.push_back(V2d(std::cos(angle), std::sin(angle)) * round->radius_mm);
    }
    return {circle};
}

double Iris::share_beyond(double radius_mm) const {
    if (radius_mm >= reach_) return 0;
    if (!(radius_mm > 0)) return 1;
    const double within =
        std::visit([&](const auto& s) { return s.area_within_mm2(radius_mm); }, shape_);
    return std::clamp(1 - within / area_, 0.0, 1.0);
}

}  // namespace petzval::camera
