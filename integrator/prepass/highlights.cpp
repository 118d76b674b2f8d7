// SPDX-License-Identifier: Apache-2.0
#include "integrator/prepass/highlights.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "camera/ray_bundle.h"
#include "core/sampling/prepass_seed.h"
#include "core/shading/surface.h"
#include "core/spectrum/colour.h"
#include "integrator/path/front_at_back.h"

namespace petzval::integrator {
namespace {

constexpr int kCell_px = 16;
constexpr int kRaysOfCell = 16;
/// Rays of the search for a pixel.
constexpr double kSearchRays = 1. / 16;
/// Lamps that are looked for in a surface, strongest first.
constexpr size_t kMostLamps = 16;
/// Images that are found at most.
constexpr size_t kMostFound = 256;
/// A rougher surface has no highlights that are small.
constexpr float kMostRoughness = 0.35f;
/// Half-width of a highlight of a rough surface: slopes of so many alpha bring most of the light.
constexpr float kAlphas = 1.5f;
/// Largest half-width of an image that is looked for, as the lens sees it, radians.
constexpr float kMostAngle = 0.05f;
/// Long side of an image over its short one.
constexpr float kMostStretched = 30;
/// Half-widths from the middle of the highlight at which it is found.
constexpr float kTolerance = 0.02f;
constexpr int kMostSteps = 12;
/// Difference of directions by which derivatives are taken, radians.
constexpr float kDifference = 1e-4f;
/// Searches for a lamp in an object that may fail, or find an image again, before it is given up.
constexpr int kMostFailures = 6;
/// Points of the lens for which an image is looked for, and of those at least that agree.
constexpr size_t kEyes = 8, kFewestEyes = 4;
/// Times the usual distance from the point where the rays of an image meet.
constexpr double kOutlier = 4;

/// A lamp to look for, or a light without size.
struct Source {
    V3f centre;  ///< at infinity the unit direction to it
    bool at_infinity;
    float reach_m;  ///< at infinity: radians
    double light;   ///< nits; of a light without size: its illuminance at 1 m, or in lux
    double strength;

    [[nodiscard]] bool has_size() const { return reach_m > 0; }
};

std::vector<Source> sources_of(const Scene& scene, std::span<const SmallFeature> features) {
    std::vector<Source> out;
    for (const SmallFeature& t : features)
        if (t.is_lamp() && t.reach_m > 0 && std::isfinite(t.reach_m) && std::isfinite(t.radiance))
            out.push_back({t.centre, t.at_infinity, t.reach_m, t.radiance, t.radiance * t.area_m2});
    for (const Light& light : scene.lights) {
        const auto add = [&](const V3f& at, bool at_infinity, Rgb colour) {
            const double sent = double(luminance(colour));
            if (sent > 0 && std::isfinite(sent)) out.push_back({at, at_infinity, 0, sent, sent});
        };
        if (const auto* point = std::get_if<PointLight>(&light))
            add(point->position, false, point->intensity_cd);
        if (const auto* spot = std::get_if<SpotLight>(&light))
            add(spot->position, false, spot->intensity_cd);
        if (const auto* measured = std::get_if<ProfileLight>(&light))  // on average
            add(measured->position, false,
                measured->factor * (scene.profiles[measured->profile].flux_lm() / (4 * kPi)));
        if (const auto* sun = std::get_if<SunLight>(&light); sun && !sun->has_disc())
            add(-sun->direction, true, sun->illuminance_lx);
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const Source& a, const Source& b) { return a.strength > b.strength; });
    if (out.size() > kMostLamps) out.resize(kMostLamps);
    return out;
}

/// A ray from the lens, and the polished surface that it meets.
struct Start {
    V3f eye, direction;
    uint32_t instance;
    size_t cell;
};

/// Where a ray from the lens meets a polished surface.
struct Met {
    Surface surface;
    V3f normal;  ///< the shaded one, unit, on the ray's side
    float alpha;
    double reflectance;

    [[nodiscard]] V3f to(const Source& lamp) const {
        return lamp.at_infinity ? lamp.centre : unit(lamp.centre - surface.p);
    }
    [[nodiscard]] float distance_m(const Source& lamp) const {
        return (lamp.centre - surface.p).length();
    }
    /// Half-width in slopes of what a lamp makes of the surface: its own, and the roughness's.
    [[nodiscard]] float half_width(const Source& lamp) const {
        return std::hypot(own_half_width(lamp), kAlphas * alpha);
    }
    [[nodiscard]] float own_half_width(const Source& lamp) const {
        return lamp.reach_m / (lamp.at_infinity ? 2 : 2 * distance_m(lamp));
    }
};

/// A lamp as one point of the lens sees it in a surface.
struct Mirrored {
    V3f eye, direction;
    Met met;
    float angle;  ///< half-width, radians
};

class HighlightSearch {
  public:
    HighlightSearch(const Scene& scene, const Bvh& bvh, int64_t most_rays)
        : scene_(scene), bvh_(bvh), rays_left_(most_rays) {}

    [[nodiscard]] bool may_go_on() const { return rays_left_ > 0; }

    /// Nothing where the ray meets no polished surface first.
    [[nodiscard]] std::optional<Met> meet(const V3f& eye, const V3f& direction) {
        Ray ray{eye, direction};
        --rays_left_;
        while (const std::optional<Hit> hit = bvh_.intersect(ray)) {
            Surface s = make_surface(scene_, direction, *hit);
            if (culled_from_view(s)) {
                if (const auto front = front_at_back(scene_, bvh_, ray, s)) {
                    s = *front;
                } else {
                    ray.origin = offset_origin(s.p, s.p_error, s.ng, direction);
                    continue;
                }
            }
            if (s.material->unlit) return std::nullopt;
            const ShadingInput at = read_material(scene_, s, -direction, Bands::rgb());
            if (at.coat.weight > 0.f && at.coat.roughness < at.bsdf.roughness &&
                at.coat.roughness <= kMostRoughness)
                return Met{s, at.frame.to_world(at.coat.normal), sqr(at.coat.roughness),
                           kCoatF0 * double(at.coat.weight)};
            if (!(at.bsdf.roughness <= kMostRoughness)) return std::nullopt;
            return Met{s, at.frame.z, sqr(at.bsdf.roughness), reflectance_of(at.bsdf)};
        }
        return std::nullopt;
    }

    /// The image of a lamp that a point of the lens sees near a direction, by Newton's method: for
    /// the direction, until the shaded normal is the one that mirrors.
    [[nodiscard]] std::optional<Mirrored> mirrored(const V3f& eye, V3f direction,
                                                   const Source& lamp) {
        std::optional<Met> here = meet(eye, direction);
        for (int i = 0; i < kMostSteps && here && rays_left_ > 0; ++i) {
            const auto half = half_way(*here, direction, lamp);
            if (!half) break;
            const Frame across = Frame::about(*half), about = Frame::about(direction);
            const auto miss = [&](const Met& met, const V3f& seen) -> std::optional<V2f> {
                const auto wanted = half_way(met, seen, lamp);
                if (!wanted || met.surface.instance != here->surface.instance) return std::nullopt;
                const V3f off = met.normal - *wanted;
                return V2f(off.dot(across.x), off.dot(across.y));
            };
            const auto moved = [&](const V3f& by) -> std::optional<V2f> {
                const V3f seen = unit(direction + by);
                const auto met = meet(eye, seen);
                return met ? miss(*met, seen) : std::nullopt;
            };
            const auto f = miss(*here, direction), right = moved(kDifference * about.x),
                       above = moved(kDifference * about.y);
            if (!f || !right || !above) break;
            const V2f by_x = (*right - *f) / kDifference, by_y = (*above - *f) / kDifference;
            const float determinant = by_x.x * by_y.y - by_x.y * by_y.x;
            const float width = here->half_width(lamp);
            if (f->length() < kTolerance * width) {
                if (!(here->normal.dot(*half) > 0.f)) break;
                return finished(eye, direction, *here, by_x, by_y, width);
            }
            const V2f step((by_y.y * f->x - by_y.x * f->y) / -determinant,
                           (by_x.x * f->y - by_x.y * f->x) / -determinant);
            if (!(step.length() < 1.f)) break;
            std::optional<Met> next;
            for (float part = 1; part > 0.1f && !next; part /= 2) {
                const V3f seen = unit(direction + part * (step.x * about.x + step.y * about.y));
                const auto met = meet(eye, seen);
                const auto off = met ? miss(*met, seen) : std::nullopt;
                if (!off || !(off->length() < f->length())) continue;
                next = met;
                direction = seen;
            }
            here = next;
        }
        return std::nullopt;
    }

    /// Whether something stands between a surface and a lamp.
    [[nodiscard]] bool is_hidden(const Mirrored& image, const Source& lamp) {
        --rays_left_;
        const Met& met = image.met;
        Ray shadow{leave_surface(met.surface, met.to(lamp), false), met.to(lamp)};
        if (!lamp.at_infinity)
            shadow.t_max = std::max(0.f, 0.999f * met.distance_m(lamp) - lamp.reach_m);
        return bvh_.occluded(shadow);
    }

  private:
    [[nodiscard]] static double reflectance_of(const BsdfInput& b) {
        const auto grey = [](f4 v) { return double(luminance(to_rgb(v, Bands::rgb()))); };
        const double metal = b.measured_metal ? 0.7 : grey(b.base_color);
        return lerp(float(grey(b.dielectric_f0)), float(metal), b.metallic);
    }
    [[nodiscard]] static std::optional<V3f> half_way(const Met& met, const V3f& seen,
                                                     const Source& lamp) {
        const V3f sum = met.to(lamp) - seen;
        if (!(sum.length2() > 1e-6f)) return std::nullopt;
        return unit(sum);
    }
    /// Nothing where the image is too large or too long.
    [[nodiscard]] static std::optional<Mirrored> finished(const V3f& eye, const V3f& direction,
                                                          const Met& met, V2f by_x, V2f by_y,
                                                          float width) {
        // Singular values of the derivatives: largest and smallest slope for a radian.
        const float sum = by_x.length2() + by_y.length2();
        const float determinant = std::fabs(by_x.x * by_y.y - by_x.y * by_y.x);
        const float root = safe_sqrt(sqr(sum / 2) - sqr(determinant));
        const float largest = std::sqrt(sum / 2 + root), smallest = determinant / largest;
        if (!(width < kMostAngle * smallest) || !(largest < kMostStretched * smallest))
            return std::nullopt;
        return Mirrored{eye, direction, met, width / smallest};
    }

    const Scene& scene_;
    const Bvh& bvh_;
    int64_t rays_left_;
};

/// The point where rays seem to meet, with least squares: that with the smallest distance to them;
/// nothing where they are parallel.
std::optional<V3d> meeting_point(const std::vector<Mirrored>& images) {
    V3d b(0.);
    Imath::M33d m(0.);  // symmetric
    for (const Mirrored& image : images) {
        const V3d d(image.direction), o(image.eye);
        for (int i = 0; i < 3; ++i) {
            V3d row = -d[i] * d;
            row[i] += 1;
            for (int k = 0; k < 3; ++k) m[i][k] += row[k];
            b[i] += row.dot(o);
        }
    }
    if (!(std::fabs(m.determinant()) > 1e-14)) return std::nullopt;
    return b * m.inverse();
}

double distance_m(const Mirrored& image, const V3d& point) {
    return (point - V3d(image.eye)).cross(V3d(image.direction)).length();
}

/// Luminance of an image: what a rough surface spreads over more slopes is as much darker.
double luminance_of(const Mirrored& image, const Source& lamp) {
    const Met& met = image.met;
    const double width = double(met.half_width(lamp)), own = double(met.own_half_width(lamp));
    const double spread = met.reflectance * lamp.light / (width * width);
    if (lamp.has_size()) return spread * own * own;
    const double away_m = lamp.at_infinity ? 1. : double(met.distance_m(lamp));
    return spread / (4 * double(kPi) * away_m * away_m);
}

/// The image that several points of the lens see, as a lamp.
std::optional<SmallFeature> thing_of(std::vector<Mirrored> images, const Source& lamp) {
    SmallFeature out{SmallFeature::Kind::Lamp, V3f(0.f)};
    V3d mean(0.);
    double angle = 0;
    for (const Mirrored& image : images) {
        mean += V3d(image.direction);
        angle = std::max(angle, double(image.angle));
        out.radiance += luminance_of(image, lamp) / double(images.size());
    }
    mean.normalize();
    double spread = 0;
    for (const Mirrored& image : images)
        spread = std::max(spread, (V3d(image.direction) - mean).length());
    if (spread <= angle / 2) {
        out.at_infinity = true;
        out.centre = V3f(mean);
        out.reach_m = out.radius_m = static_cast<float>(angle + spread);
        out.area_m2 = double(kPi) * angle * angle;
        return out;
    }
    // A ray may have found another image: those that pass far from where the others meet are left
    // out.
    std::optional<V3d> centre = meeting_point(images);
    while (centre && images.size() > kFewestEyes) {
        std::sort(images.begin(), images.end(), [&](const Mirrored& a, const Mirrored& b) {
            return distance_m(a, *centre) < distance_m(b, *centre);
        });
        const double middle = distance_m(images[images.size() / 2], *centre);
        if (distance_m(images.back(), *centre) <= kOutlier * middle) break;
        images.pop_back();
        centre = meeting_point(images);
    }
    if (!centre) return std::nullopt;
    double farthest_m = 0, off_m = 0;
    for (const Mirrored& image : images) {
        const double along = (*centre - V3d(image.eye)).dot(V3d(image.direction));
        if (!(along > 0)) return std::nullopt;
        farthest_m = std::max(farthest_m, along);
        off_m = std::max(off_m, distance_m(image, *centre));
    }
    out.centre = V3f(*centre);
    const double image_m = angle * farthest_m, reach_m = image_m + off_m;
    out.reach_m = out.radius_m = static_cast<float>(reach_m);
    // Spread over the disc: an image that is blurred must not look like a large lamp.
    out.radiance *= image_m * image_m / (reach_m * reach_m);
    out.area_m2 = double(kPi) * double(out.reach_m) * double(out.reach_m);
    return out;
}

/// Whether two images are one, as seen from the lens: how far away it is, is known less well.
bool is_same(const SmallFeature& a, const SmallFeature& b, const V3f& eye) {
    constexpr float kSameDistance = 0.1f;
    if (a.at_infinity != b.at_infinity) return false;
    const V3f apart = b.centre - a.centre;
    const float reach_m = 2 * std::max(a.reach_m, b.reach_m);
    if (a.at_infinity) return apart.length() < reach_m;
    const V3f to = a.centre - eye;
    const float along = apart.dot(unit(to));
    return (apart - along * unit(to)).length() < reach_m &&
           std::fabs(along) < kSameDistance * to.length();
}

/// The image of a lamp near a start, as that point of the lens and others see it.
std::optional<SmallFeature> image_from(HighlightSearch& search, const Start& start,
                                       const std::vector<V3f>& eyes, const Source& lamp) {
    const auto found = search.mirrored(start.eye, start.direction, lamp);
    if (!found || search.is_hidden(*found, lamp)) return std::nullopt;
    std::vector<Mirrored> images{*found};
    for (const V3f& eye : eyes) {
        if (images.size() == kEyes) break;
        if (eye == start.eye) continue;
        if (const auto more = search.mirrored(eye, unit(found->met.surface.p - eye), lamp))
            images.push_back(*more);
    }
    if (images.size() < kFewestEyes) return std::nullopt;
    return thing_of(std::move(images), lamp);
}

/// Rays of all cells of a frame that meet polished surfaces, the objects by turns.
std::vector<Start> starts_of(const camera::Camera& camera, HighlightSearch& search, V2i frame_px,
                             std::vector<std::vector<V3f>>& eyes) {
    const V2i cells = frame_px / kCell_px;
    std::map<uint32_t, std::vector<Start>> by_instance;
    for (int j = 0; j < cells.y; ++j)
        for (int i = 0; i < cells.x; ++i) {
            std::vector<V3f>& eyes_of_cell = eyes.emplace_back();
            const camera::FilmCell cell{V2f(V2i(i, j)) / V2f(cells),
                                        V2f(V2i(i + 1, j + 1)) / V2f(cells)};
            for (const Ray& ray :
                 camera::bundle_of(camera, cell, number_of(PrepassSeed::Highlights), {i, j},
                                   kRaysOfCell)
                     .rays) {
                eyes_of_cell.push_back(ray.origin);
                if (const auto met = search.meet(ray.origin, ray.direction))
                    by_instance[met->surface.hit.instance].push_back(
                        {ray.origin, ray.direction, met->surface.hit.instance, eyes.size() - 1});
            }
        }
    // First one of each object, then another of each. Neighbours see the same: they are mixed.
    struct Turn {
        size_t turn;
        Start start;
    };
    std::vector<Turn> turns;
    for (const auto& [instance, starts] : by_instance) {
        std::vector<size_t> order(starts.size());
        std::iota(order.begin(), order.end(), 0);
        std::sort(order.begin(), order.end(), [](size_t a, size_t b) {
            return hash32(static_cast<uint32_t>(a)) < hash32(static_cast<uint32_t>(b));
        });
        for (size_t n = 0; n < order.size(); ++n) turns.push_back({n, starts[order[n]]});
    }
    std::stable_sort(turns.begin(), turns.end(),
                     [](const Turn& a, const Turn& b) { return a.turn < b.turn; });
    std::vector<Start> out;
    for (const Turn& turn : turns) out.push_back(turn.start);
    return out;
}

}  // namespace

std::vector<SmallFeature> highlights(const camera::Camera& camera, const Scene& scene,
                                     const Bvh& bvh, V2i frame_px,
                                     std::span<const SmallFeature> features) {
    const std::vector<Source> lamps = sources_of(scene, features);
    if (lamps.empty() || frame_px.x < kCell_px || frame_px.y < kCell_px) return {};
    const double pixels = double(frame_px.x) * double(frame_px.y);
    HighlightSearch first(scene, bvh, INT64_MAX);
    std::vector<std::vector<V3f>> eyes;
    const std::vector<Start> starts = starts_of(camera, first, frame_px, eyes);
    HighlightSearch search(scene, bvh, static_cast<int64_t>(kSearchRays * pixels));
    std::map<std::pair<uint32_t, size_t>, int> failures;  // by object and lamp
    std::vector<SmallFeature> out;
    for (const Start& start : starts)
        for (size_t l = 0; l < lamps.size(); ++l) {
            const Source& lamp = lamps[l];
            if (!search.may_go_on() || out.size() == kMostFound) return out;
            int& failed = failures[{start.instance, l}];
            if (failed > kMostFailures) continue;
            const auto feature = image_from(search, start, eyes[start.cell], lamp);
            const auto same = [&](const SmallFeature& other) {
                return is_same(other, *feature, start.eye);
            };
            if (!feature || std::any_of(out.begin(), out.end(), same))
                ++failed;
            else
                out.push_back(*feature);
        }
    return out;
}

}  // namespace petzval::integrator
