// SPDX-License-Identifier: Apache-2.0
#include "integrator/prepass/image_fit.h"

#include <algorithm>
#include <cmath>

namespace petzval::integrator {
namespace {

/// Points of the lens that must agree.
constexpr size_t kFewestEyes = 4;
/// Half-widths by which rays may miss an image for it to be one.
constexpr float kMostOff = 3;
/// Long side of an image over its short one, up to which a ball about it will do.
constexpr float kMostStretchedInBall = 30;
/// Times the usual distance from the point where the rays of an image meet.
constexpr double kOutlier = 4;

/// Whether a ball about an image would be much larger than it.
bool is_long(const LampImage& image) {
    const float most = image.in_half_widths.most();
    return sqr(most) > kMostStretchedInBall * std::fabs(image.in_half_widths.determinant());
}

/// The point where rays seem to meet, with least squares: that with the smallest distance to them;
/// nothing where they are parallel.
std::optional<V3d> meeting_point(const std::vector<LampImage>& images) {
    V3d b(0.);
    Imath::M33d m(0.);  // symmetric
    for (const LampImage& image : images) {
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

double distance_m(const LampImage& image, const V3d& point) {
    return (point - V3d(image.eye)).cross(V3d(image.direction)).length();
}

/// Luminance of an image: what a rough surface spreads over more slopes is as much darker.
double luminance_of(const LampImage& image, const Source& lamp) {
    const Met& met = image.met;
    const double width = double(met.half_width(lamp)), own = double(met.own_half_width(lamp));
    const double spread = met.share * lamp.light / (width * width);
    if (lamp.has_size()) return spread * own * own;
    const double away_m = lamp.at_infinity ? 1. : double(met.distance_m(lamp));
    return spread / (4 * double(kPi) * away_m * away_m);
}

/// Where the rays of an image pass its middle, by their directions.
struct Passing {
    V2f middle_m;        ///< of the mean direction
    Linear2f by_change;  ///< metres, for a change of the direction
};

/// By least squares; nothing where the directions differ by less than `least` in some way, as a
/// standard deviation.
std::optional<Passing> passing(const std::vector<V2d>& changes, const std::vector<V2d>& places_m,
                               double least) {
    Imath::M33d m(0.);
    V3d x(0.), y(0.);
    for (size_t n = 0; n < changes.size(); ++n) {
        const V3d row(1, changes[n].x, changes[n].y);
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) m[i][k] += row[i] * row[k];
        x += row * places_m[n].x, y += row * places_m[n].y;
    }
    const double count = m[0][0];
    const V2f mean(V2d(m[0][1], m[0][2]) / count);
    const auto both = static_cast<float>(m[1][2] / count) - mean.x * mean.y;
    const Linear2f spread{V2f(static_cast<float>(m[1][1] / count) - sqr(mean.x), both),
                          V2f(both, static_cast<float>(m[2][2] / count) - sqr(mean.y))};
    if (!(double(spread.determinant()) > least * least * double(spread.most())))
        return std::nullopt;
    const Imath::M33d inverse = m.inverse();
    x = x * inverse, y = y * inverse;
    return Passing{V2f(V2d(x[0], y[0])), {V2f(V2d(x[1], y[1])), V2f(V2d(x[2], y[2]))}};
}

/// Makes the ball about an image the image itself: what rays through all points of the lens have in
/// common. It stays a ball where they do not tell. angle: half-width of the image, radians.
void see_astigmatism(SmallFeature& ball, const std::vector<LampImage>& images, const V3d& mean,
                     double angle, double luminance) {
    const Frame frame = Frame::about(V3f(mean));
    const V3d x(frame.x), y(frame.y);
    const auto across = [&](const V3d& v) { return V2d(v.dot(x), v.dot(y)); };
    std::vector<V2d> changes, places_m;
    const auto away_m = [&](const LampImage& image) {
        return (V3d(ball.centre) - V3d(image.eye)).dot(mean) / V3d(image.direction).dot(mean);
    };
    for (const LampImage& image : images) {
        const V3d direction(image.direction);
        changes.push_back(across(direction));
        places_m.push_back(across(V3d(image.eye) + away_m(image) * direction - V3d(ball.centre)));
    }
    const auto fitted = passing(changes, places_m, angle / 2);
    if (!fitted) return;
    // Rays from one eye: a change of the direction moves the place, and what belongs to the new
    // direction.
    const Frame about = Frame::about(images[0].direction);
    const Linear2f turned{V2f(about.x.dot(frame.x), about.y.dot(frame.x)),
                          V2f(about.x.dot(frame.y), about.y.dot(frame.y))},
        by_change = Linear2f() * static_cast<float>(away_m(images[0])) + fitted->by_change * -1.f;
    Linear2f place_per_m = images[0].in_half_widths.after(turned).after(by_change.inverse());
    float off = 0;
    for (size_t n = 0; n < changes.size(); ++n)
        off = std::max(off, place_per_m(V2f(places_m[n]) - fitted->middle_m -
                                        fitted->by_change(V2f(changes[n])))
                                .length());
    const double area_m2 = double(kPi) / std::fabs(double(place_per_m.determinant()));
    if (!(off < kMostOff) || !std::isfinite(area_m2)) return;
    place_per_m = place_per_m * (1 / (1 + off));
    const V3f moved = fitted->middle_m.x * frame.x + fitted->middle_m.y * frame.y;
    ball.centre += moved;
    ball.reach_m += moved.length();
    ball.radius_m = ball.reach_m;
    ball.image = {V3f(mean), frame.x, frame.y, fitted->by_change, place_per_m};
    ball.radiance = luminance / double(sqr(1 + off));
    ball.area_m2 = area_m2 * double(sqr(1 + off));
}

}  // namespace

std::optional<SmallFeature> lamp_of(std::vector<LampImage> images, const Source& lamp) {
    if (images.size() < kFewestEyes) return std::nullopt;
    SmallFeature out{SmallFeature::Kind::Lamp, V3f(0.f)};
    V3d mean(0.);
    double angle = 0, luminance = 0;
    for (const LampImage& image : images) {
        mean += V3d(image.direction);
        angle = std::max(angle, double(image.angle));
        luminance += luminance_of(image, lamp) / double(images.size());
    }
    out.radiance = luminance;
    mean.normalize();
    double spread = 0;
    for (const LampImage& image : images)
        spread = std::max(spread, (V3d(image.direction) - mean).length());
    if (spread <= angle / 2 && !is_long(images[0])) {
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
        std::sort(images.begin(), images.end(), [&](const LampImage& a, const LampImage& b) {
            return distance_m(a, *centre) < distance_m(b, *centre);
        });
        const double middle = distance_m(images[images.size() / 2], *centre);
        if (distance_m(images.back(), *centre) <= kOutlier * middle) break;
        images.pop_back();
        centre = meeting_point(images);
    }
    if (!centre) return std::nullopt;
    double farthest_m = 0, off_m = 0;
    for (const LampImage& image : images) {
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
    see_astigmatism(out, images, mean, angle, luminance);
    if (!out.image && is_long(images[0])) return std::nullopt;
    return out;
}

}  // namespace petzval::integrator
