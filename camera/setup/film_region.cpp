// SPDX-License-Identifier: Apache-2.0
#include "camera/setup/film_region.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace petzval {
namespace {

constexpr double kFirstCells = 512;
constexpr size_t kMostRects = 32;

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

/// The region in finer and finer cells, until they are pixels or too many.
FilmRegion refined(const Camera& camera, V2i size_px, const Thing& thing, std::vector<Rect> cells) {
    while (!cells.empty() && cells.size() < kMostRects && cells[0].width() > 1) {
        std::vector<Rect> finer;
        for (const Rect& cell : cells)
            for (const Rect& part : quarters(cell))
                if (passes(bundle_of(camera, size_px, part), thing)) finer.push_back(part);
        if (finer.size() > 2 * kMostRects) break;
        cells = std::move(finer);
    }
    return {std::move(cells)};
}

}  // namespace

RayBundle bundle_of(const Camera& camera, V2i size_px, const Rect& cell, int rays) {
    RayBundle out;
    const V2f size(size_px);
    for (uint32_t i = 0; i < static_cast<uint32_t>(rays); ++i) {
        const Sampler sampler(SamplerKind::Owen, 0, {cell.x0, cell.y0, i});
        // The corners, and points within.
        const V2f within = i < 4 ? V2f(float(i & 1), float(i >> 1)) : sampler.get2(Dim::Film);
        const V2f at(float(cell.x0) + within.x * float(cell.width()),
                     float(cell.y0) + within.y * float(cell.height()));
        const CameraSample seen = camera.sample({at / size, sampler}, Bands::rgb());
        if (seen.empty()) continue;
        out.rays.push_back(seen[0].ray);
        out.direction += seen[0].ray.direction;
    }
    const float length = out.direction.length();
    out.direction = length > 0 ? out.direction / length : V3f(0.f);
    return out;
}

bool has_same_rays(const Camera& a, const Camera& b) {
    constexpr V2i kFrame(6, 6);
    const auto same = [](const Ray& left, const Ray& right) {
        return left.origin == right.origin && left.direction == right.direction;
    };
    for (int y = 0; y < kFrame.y; ++y)
        for (int x = 0; x < kFrame.x; ++x) {
            const Rect cell{x, y, x + 1, y + 1};
            const RayBundle of_a = bundle_of(a, kFrame, cell), of_b = bundle_of(b, kFrame, cell);
            if (!std::equal(of_a.rays.begin(), of_a.rays.end(), of_b.rays.begin(), of_b.rays.end(),
                            same))
                return false;
        }
    return true;
}

bool passes(const RayBundle& bundle, const Thing& thing, float margin) {
    const V3f w = bundle.direction;
    if (!(w.length2() > 0)) return false;
    const Frame frame = Frame::about(w);
    Imath::Box2f span;
    for (const Ray& ray : bundle.rays) {
        const V3f to = thing.at_infinity ? thing.centre : thing.centre - ray.origin;
        if (!thing.at_infinity && to.length2() <= thing.radius_m * thing.radius_m) return true;
        const float forward = ray.direction.dot(w), t = to.dot(w) / forward;
        if (!(forward > 0) || !(t > 0)) continue;
        const V3f beside = t * ray.direction - to;
        span.extendBy(V2f(beside.dot(frame.x), beside.dot(frame.y)));
    }
    if (span.isEmpty()) return false;
    const V2f middle = span.center(), half = span.size() / 2;
    return std::fabs(middle.x) <= half.x * (1 + margin) + thing.radius_m &&
           std::fabs(middle.y) <= half.y * (1 + margin) + thing.radius_m;
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
                                     std::span<const Thing> things) {
    std::vector<FilmRegion> out;
    if (things.empty()) return out;
    const std::vector<Rect> cells = first_cells(size_px);
    std::vector<RayBundle> bundles;
    for (const Rect& cell : cells) bundles.push_back(bundle_of(camera, size_px, cell));
    for (const Thing& thing : things) {
        std::vector<Rect> met;
        for (size_t i = 0; i < cells.size(); ++i)
            if (passes(bundles[i], thing)) met.push_back(cells[i]);
        out.push_back(refined(camera, size_px, thing, std::move(met)));
    }
    return out;
}

}  // namespace petzval
