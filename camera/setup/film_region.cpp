// SPDX-License-Identifier: Apache-2.0
#include "camera/setup/film_region.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace petzval::camera {
namespace {

constexpr double kFirstCells = 512;
constexpr size_t kMostRects = 32;
constexpr float kWide_rad = 0.25f;

std::vector<Rect> first_cells(V2i size) {
    const auto side =
        static_cast<int>(std::ceil(std::sqrt(double(size.x) * double(size.y) / kFirstCells)));
    std::vector<Rect> out;
    for (int y = 0; y < size.y; y += side)
        for (int x = 0; x < size.x; x += side)
            out.push_back({x, y, std::min(x + side, size.x), std::min(y + side, size.y)});
    return out;
}

std::vector<Rect> quarters(const Rect& r) {
    const int x = r.x0 + (r.width() + 1) / 2, y = r.y0 + (r.height() + 1) / 2;
    std::vector<Rect> out;
    for (const Rect& part : {Rect{r.x0, r.y0, x, y}, Rect{x, r.y0, r.x1, y}, Rect{r.x0, y, x, r.y1},
                             Rect{x, y, r.x1, r.y1}})
        if (part.width() > 0 && part.height() > 0) out.push_back(part);
    return out;
}

/// Bundle of a rectangle of a frame.
RayBundle rays_of(const Camera& camera, V2i size_px, const Rect& cell) {
    const V2f size(size_px);
    return bundle_of(camera, {V2f(V2i(cell.x0, cell.y0)) / size, V2f(V2i(cell.x1, cell.y1)) / size},
                     0, {cell.x0, cell.y0});
}

/// The region in finer and finer cells, until they are pixels or too many.
FilmRegion refined(const Camera& camera, V2i size_px, const SmallFeature& feature,
                   std::vector<Rect> cells) {
    while (!cells.empty() && cells.size() < kMostRects && cells[0].width() > 1) {
        std::vector<Rect> finer;
        for (const Rect& cell : cells)
            for (const Rect& part : quarters(cell))
                if (passes(rays_of(camera, size_px, part), feature)) finer.push_back(part);
        if (finer.size() > 2 * kMostRects) break;
        cells = std::move(finer);
    }
    return {std::move(cells)};
}

/// Whether a thing lies in the cone of a bundle's rays, widened: a quick test, never false where
/// passes() is true. 1.5: the corners of what the rays span.
bool may_pass(const RayBundle& bundle, const SmallFeature& feature, float margin) {
    const float wider = 1.5f * (1 + margin);
    const V3f to = feature.at_infinity ? feature.centre : feature.centre - bundle.origin;
    const float away_m = to.length(), beside_m = wider * bundle.reach_m + 1.5f * feature.radius_m;
    if (!feature.at_infinity && away_m <= beside_m) return true;
    // The plane of a wide spot of the sky is far from a cone.
    if (feature.at_infinity && feature.radius_m > kWide_rad) return true;
    const float own = feature.at_infinity ? 1.5f * feature.radius_m : std::asin(beside_m / away_m);
    const float angle = wider * std::acos(std::min(1.f, bundle.least_cosine)) + own;
    return angle >= kPi / 2 || to.dot(bundle.direction) >= std::cos(angle) * away_m;
}

}  // namespace

bool passes(const RayBundle& bundle, const SmallFeature& feature, float margin) {
    const V3f w = bundle.direction;
    if (!(w.length2() > 0)) return false;
    if (!may_pass(bundle, feature, margin)) return false;
    const Frame frame = Frame::about(w);
    Imath::Box2f span;
    for (const Ray& ray : bundle.rays) {
        const V3f to = feature.at_infinity ? feature.centre : feature.centre - ray.origin;
        if (!feature.at_infinity && to.length2() <= feature.radius_m * feature.radius_m)
            return true;
        const float forward = ray.direction.dot(w), t = to.dot(w) / forward;
        if (!(forward > 0) || !(t > 0)) continue;
        const V3f beside = t * ray.direction - to;
        span.extendBy(V2f(beside.dot(frame.x), beside.dot(frame.y)));
    }
    if (span.isEmpty()) return false;
    const V2f middle = span.center(), half = span.size() / 2;
    return std::fabs(middle.x) <= half.x * (1 + margin) + feature.radius_m &&
           std::fabs(middle.y) <= half.y * (1 + margin) + feature.radius_m;
}

int64_t FilmRegion::area_px() const {
    int64_t sum = 0;
    for (const Rect& r : rects) sum += int64_t{r.width()} * r.height();
    return sum;
}

bool FilmRegion::contains(int x, int y) const {
    return std::any_of(rects.begin(), rects.end(), [&](const Rect& r) {
        return x >= r.x0 && x < r.x1 && y >= r.y0 && y < r.y1;
    });
}

std::array<int, 2> FilmRegion::pixel(int64_t i) const {
    for (const Rect& r : rects) {
        const int64_t area = int64_t{r.width()} * r.height();
        if (i < area)
            return {r.x0 + static_cast<int>(i % r.width()), r.y0 + static_cast<int>(i / r.width())};
        i -= area;
    }
    return {0, 0};
}

std::vector<FilmRegion> film_regions(const Camera& camera, V2i size_px,
                                     std::span<const SmallFeature> features) {
    std::vector<FilmRegion> out;
    if (features.empty()) return out;
    const std::vector<Rect> cells = first_cells(size_px);
    std::vector<RayBundle> bundles;
    for (const Rect& cell : cells) bundles.push_back(rays_of(camera, size_px, cell));
    for (const SmallFeature& feature : features) {
        std::vector<Rect> met;
        for (size_t i = 0; i < cells.size(); ++i)
            if (passes(bundles[i], feature)) met.push_back(cells[i]);
        out.push_back(refined(camera, size_px, feature, std::move(met)));
    }
    return out;
}

}  // namespace petzval::camera
