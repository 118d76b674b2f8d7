// SPDX-License-Identifier: Apache-2.0
#include "integrator/prepass/highlight_search.h"

#include <algorithm>
#include <cmath>

#include "core/spectrum/colour.h"
#include "integrator/path/front_at_back.h"

namespace petzval::integrator {
namespace {

/// Half-width of a highlight of a rough surface: slopes of so many alpha bring most of the light.
constexpr float kAlphas = 1.5f;
/// Largest half-width of an image that is looked for, as the lens sees it, radians.
constexpr float kMostAngle = 0.05f;
/// Long side of an image over its short one: in a bar it is the distance over the radius, or so.
constexpr float kMostStretched = 1000;
/// Half-widths from the middle of the highlight at which it is found.
constexpr float kTolerance = 0.02f;
constexpr int kMostSteps = 12;
/// Share of the miss that a step may leave for the next one to go by the same slopes.
constexpr float kStraight = 0.25f;
/// Difference of directions by which derivatives are taken, radians.
constexpr float kDifference = 1e-4f;
/// Surfaces of glass that a ray may meet before it leaves.
constexpr int kMostBends = 6;
/// A rougher glass has no images that are small.
constexpr float kClearRoughness = 0.03f;

double grey(f4 v) {
    return double(luminance(to_rgb(v, Bands::rgb())));
}

double reflectance_of(const BsdfInput& b) {
    const double metal = b.measured_metal ? 0.7 : grey(b.base_color);
    return lerp(float(grey(b.dielectric_f0)), float(metal), b.metallic);
}

bool is_clear_glass(const BsdfInput& b) {
    return b.transmission > 0.5f && !b.thin && b.metallic < 0.5f && b.roughness < kClearRoughness;
}

/// What `aim` must be: half-way between the directions to the lens and to the lamp; or to the lamp.
std::optional<V3f> wanted(const Met& met, const V3f& seen, const Source& lamp) {
    if (met.way == Way::Through) return met.to(lamp);
    const V3f sum = met.to(lamp) - seen;
    if (!(sum.length2() > 1e-6f)) return std::nullopt;
    return unit(sum);
}

/// Nothing where the image is too large or too long.
std::optional<LampImage> finished(const V3f& eye, const V3f& direction, const Met& met,
                                  const Linear2f& by, float width) {
    // Largest and smallest slope for a radian.
    const float largest = by.most(), smallest = std::fabs(by.determinant()) / largest;
    if (!(width < kMostAngle * smallest) || !(largest < kMostStretched * smallest))
        return std::nullopt;
    return LampImage{eye, direction, met, width / smallest, by * (1 / width)};
}

}  // namespace

float Met::half_width(const Source& lamp) const {
    return std::hypot(own_half_width(lamp), kAlphas * alpha);
}

std::optional<Shaded> HighlightSearch::first(Ray ray) {
    --rays_left_;
    while (const std::optional<Hit> hit = bvh_.intersect(ray)) {
        Surface s = make_surface(scene_, ray.direction, *hit);
        if (culled_from_view(s)) {
            if (const auto front = front_at_back(scene_, bvh_, ray, s)) {
                s = *front;
            } else {
                ray.origin = offset_origin(s.p, s.p_error, s.ng, ray.direction);
                continue;
            }
        }
        if (s.material->unlit) return std::nullopt;
        return Shaded{s, read_material(scene_, s, -ray.direction, Bands::rgb())};
    }
    return std::nullopt;
}

std::optional<Met> HighlightSearch::meet(const V3f& eye, const V3f& direction, Way way) {
    const auto shaded = first({eye, direction});
    return shaded ? met(*shaded, direction, way) : std::nullopt;
}

std::optional<Met> HighlightSearch::met(const Shaded& shaded, const V3f& direction, Way way) {
    if (way == Way::Through) return behind_glass(shaded, direction);
    const auto& [s, at] = shaded;
    if (at.coat.weight > 0.f && at.coat.roughness < at.bsdf.roughness &&
        at.coat.roughness <= kMostRoughness)
        return Met{way,
                   s.p,
                   s,
                   at.frame.to_world(at.coat.normal),
                   sqr(at.coat.roughness),
                   kCoatF0 * double(at.coat.weight)};
    if (!(at.bsdf.roughness <= kMostRoughness)) return std::nullopt;
    return Met{way, s.p, s, at.frame.z, sqr(at.bsdf.roughness), reflectance_of(at.bsdf)};
}

// Snell's law at each surface; where it has no answer the ray is reflected. Other glass or things
// within end the way.
std::optional<Met> HighlightSearch::behind_glass(Shaded shaded, V3f direction) {
    double share = 1;
    const V3f entered = shaded.surface.p;
    for (int i = 0; i < kMostBends; ++i) {
        const auto& [s, at] = shaded;
        if (!is_clear_glass(at.bsdf)) return std::nullopt;
        if (s.front != (i == 0)) return std::nullopt;
        const V3f n = at.frame.z;
        const float eta = at.bsdf.eta[1], cosine = -direction.dot(n),
                    squared = 1 - (1 - sqr(cosine)) / sqr(eta);
        const bool leaves = squared > 0;
        const V3f along = leaves ? direction / eta + n * (cosine / eta - std::sqrt(squared))
                                 : direction + n * (2 * cosine);
        direction = unit(along);
        if (leaves) share *= (1 - double(at.bsdf.dielectric_f0[1])) * double(at.bsdf.transmission);
        if (leaves && !s.front) return Met{Way::Through, entered, s, direction, 0, share};
        auto next = first({leave_surface(s, direction, leaves), direction});
        if (!next) return std::nullopt;
        shaded = *next;
    }
    return std::nullopt;
}

std::optional<LampImage> HighlightSearch::image(const V3f& eye, V3f direction, const Source& lamp,
                                                Way way, const LampImage* beside) {
    std::optional<Met> here = meet(eye, direction, way);
    // Of the miss, by the direction: known from another place, or found here.
    std::optional<Linear2f> slopes;
    // Frames of directions nearby may be turned against each other.
    constexpr float kSameAxes = 0.99f;
    if (beside && Frame::about(beside->direction).x.dot(Frame::about(direction).x) < kSameAxes)
        beside = nullptr;
    if (beside) slopes = beside->in_half_widths * beside->met.half_width(lamp);
    for (int i = 0; i < kMostSteps && here && rays_left_ > 0; ++i) {
        const auto aim = wanted(*here, direction, lamp);
        if (!aim) break;
        const Frame across = Frame::about(*aim), about = Frame::about(direction);
        const auto miss = [&](const Met& met, const V3f& seen) -> std::optional<V2f> {
            const auto other = wanted(met, seen, lamp);
            if (!other || met.surface.instance != here->surface.instance) return std::nullopt;
            const V3f off = met.aim - *other;
            return V2f(off.dot(across.x), off.dot(across.y));
        };
        const auto f = miss(*here, direction);
        if (!f) break;
        const float width = here->half_width(lamp);
        const bool is_there = f->length() < kTolerance * width;
        const bool finds = !slopes || (is_there && !beside);
        if (finds) {
            const auto slope = [&](const V3f& along) -> std::optional<V2f> {
                // At an edge of the object one side sees past it.
                for (const float by : {kDifference, -kDifference}) {
                    const V3f seen = unit(direction + by * along);
                    const auto met = meet(eye, seen, way);
                    if (const auto moved = met ? miss(*met, seen) : std::nullopt)
                        return (*moved - *f) / by;
                }
                return std::nullopt;
            };
            const auto by_x = slope(about.x), by_y = slope(about.y);
            if (!by_x || !by_y) break;
            slopes = Linear2f{*by_x, *by_y};
        }
        if (is_there) {
            if (!(here->aim.dot(*aim) > 0.f)) break;
            return finished(eye, direction, *here, *slopes, width);
        }
        // Slopes of elsewhere that lead nowhere are found anew.
        const V2f step = -slopes->inverse()(*f);
        const float least_part = finds ? 0.1f : 0.6f;
        std::optional<Met> next;
        float left = 1;
        for (float part = 1; step.length() < 1.f && part > least_part && !next; part /= 2) {
            const V3f seen = unit(direction + part * (step.x * about.x + step.y * about.y));
            const auto met = meet(eye, seen, way);
            const auto off = met ? miss(*met, seen) : std::nullopt;
            if (!off || !(off->length() < f->length())) continue;
            next = met;
            direction = seen;
            left = off->length() / f->length();
        }
        if (next || finds) here = next;
        if (!(left < kStraight)) slopes.reset();
    }
    return std::nullopt;
}

bool HighlightSearch::is_hidden(const LampImage& image, const Source& lamp) {
    --rays_left_;
    const Met& met = image.met;
    const V3f to = met.to(lamp);
    Ray shadow{leave_surface(met.surface, to, met.way == Way::Through), to};
    if (!lamp.at_infinity)
        shadow.t_max = std::max(0.f, 0.999f * met.distance_m(lamp) - lamp.reach_m);
    return bvh_.occluded(shadow);
}

}  // namespace petzval::integrator
