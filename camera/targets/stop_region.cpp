// SPDX-License-Identifier: Apache-2.0
#include "camera/targets/stop_region.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "core/sampling/warp.h"

namespace petzval::camera {
namespace {

constexpr float kPi_f = static_cast<float>(kPi);
/// Change of a derivative over a square, as a share of its least stretch, up to which Newton's
/// method is left to find the one way there.
constexpr float kSmooth = 0.5f;
/// Departure from a straight map, in what counts as on the target, up to which one stands for it:
/// in an ellipse, and in a strip.
constexpr float kBent = 0.08f, kBentStrip = 0.3f;
/// Roots this near to each other on the target are one.
constexpr float kSame = 0.2f;
/// Curvature within a square over the one that its quarters show.
constexpr float kBendMargin = 1.5f;
constexpr int kSteps = 3;
/// Share of a distance that rounding may take: where the map is straight, an ellipse's rim is at
/// it.
constexpr float kInRounding = 0.99f;
/// Distance from a target's middle, in its radii, at which a ray is there.
constexpr float kThere = 0.05f;
constexpr float kRoot2 = 1.41421356f;

}  // namespace

LandingMap::LandingMap(const StopMap::Rays& rays, const ListedTarget& t) {
    for (size_t k = 0; k < StopMap::kTerms; ++k) {
        const V2f landed =
            t.by_place(V2f(rays[k][0], rays[k][1])) + t.by_slope(V2f(rays[k][2], rays[k][3]));
        x[k] = landed.x, y[k] = landed.y;
    }
    x[0] -= t.centre.x, y[0] -= t.centre.y;
}

V2f landing(const f4& ray, const ListedTarget& t) {
    return t.by_place(V2f(ray[0], ray[1])) + t.by_slope(V2f(ray[2], ray[3])) - t.centre;
}

FilmMotion::FilmMotion(const std::array<StopMap::Rays, 2>& by_film, const ListedTarget& target,
                       V2f stop) {
    const auto change = [&](const f4& ray) { return landing(ray, target) + target.centre; };
    right = change(at(by_film[0], stop)), down = change(at(by_film[1], stop));
}

V2f FilmMotion::film_for(V2f landing) const {
    return Linear2f{right, down}.inverse()(landing);
}

Landings landings(const LandingMap& map, f8 s, f8 t) {
    Landings out{};
    size_t end = StopMap::kTerms;
    for (int j = StopMap::kDegree; j >= 0; --j) {
        const size_t count = static_cast<size_t>(StopMap::kDegree - j) + 1;
        f8 x = f8{} + map.x[end - 1], y = f8{} + map.y[end - 1], x_by{}, y_by{};
        for (size_t i = 2; i <= count; ++i) {
            x_by = x_by * s + x, y_by = y_by * s + y;
            x = x * s + map.x[end - i], y = y * s + map.y[end - i];
        }
        out.x_by_t = out.x_by_t * t + out.x, out.y_by_t = out.y_by_t * t + out.y;
        out.x_by_s = out.x_by_s * t + x_by, out.y_by_s = out.y_by_s * t + y_by;
        out.x = out.x * t + x, out.y = out.y * t + y;
        end -= count;
    }
    return out;
}

bool StopRegion::Shape::contains(V2f p) const {
    const V2f d = p - middle;
    const float det = by_x.x * by_y.y - by_x.y * by_y.x;
    const float u = (d.x * by_y.y - d.y * by_y.x) / det, v = (d.y * by_x.x - d.x * by_x.y) / det;
    return is_square ? std::fabs(u) <= 1 && std::fabs(v) <= 1 : u * u + v * v <= 1;
}

// More than there is room for: the whole stop covers all of it.
void StopRegion::add(const Shape& shape) {
    if (count_ == kMost) {
        count_ = 0, areas_ = {};
        shapes_[0] = {V2f(0.f), V2f(1, 0), V2f(0, 1), 4, true, 0};
        is_whole_ = true;
    }
    if (is_whole_) {
        count_ = 1, areas_ = {0, 4};
        return;
    }
    shapes_[count_++] = shape;
    areas_[shape.is_square] += shape.area;
}

// By eight points of its rim: the curvature is that of a square, and the ellipse may reach beyond.
bool StopRegion::is_around(const LandingMap& map, const Shape& ellipse, float reach) {
    constexpr float kHalf = 0.70710678f;
    const f8 along{1, kHalf, 0, -kHalf, -1, -kHalf, 0, kHalf},
        across{0, kHalf, 1, kHalf, 0, -kHalf, -1, -kHalf};
    const Landings rim =
        landings(map, ellipse.middle.x + along * ellipse.by_x.x + across * ellipse.by_y.x,
                 ellipse.middle.y + along * ellipse.by_x.y + across * ellipse.by_y.y);
    ++evaluations_;
    return !any(rim.x * rim.x + rim.y * rim.y < sqr(kInRounding * reach));
}

// The landing is off from its linear part by half the curvature times the distance squared.
bool StopRegion::add_ellipse(const LandingMap& map, V2f s, const Landings& at, int i, float reach,
                             float curvature) {
    const float a = at.x_by_s[i], b = at.x_by_t[i], c = at.y_by_s[i], d = at.y_by_t[i];
    const float det = a * d - b * c, least = at.stretch()[1][i];
    const float across = reach / least, bent = curvature * across * across / 2;
    if (!(bent < kBent * reach)) return false;
    const float wide = reach + bent;
    if (s.length() > 1 + wide / least) return true;  // no part of it is on the stop
    for (size_t k = 0; k < count_; ++k) {
        if (shapes_[k].is_square) continue;
        const V2f off = shapes_[k].middle - s;
        if (V2f(a * off.x + b * off.y, c * off.x + d * off.y).length() < kSame * reach) return true;
    }
    const Shape shape{s,
                      V2f(d, -c) * (wide / det),
                      V2f(-b, a) * (wide / det),
                      kPi_f * wide * wide / std::fabs(det),
                      false,
                      wide,
                      bent / (reach * reach)};
    if (!is_around(map, shape, reach)) return false;
    add(shape);
    return true;
}

/// Part of a square, half as wide as `half`, in which a landing that is straight lies within `wide`
/// of the target: along its largest stretch and across. No area where there is none.
StopRegion::Shape StopRegion::strip(V2f middle, float half, const Landings& at, int i, float wide) {
    const V2f by_s(at.x_by_s[i], at.y_by_s[i]), by_t(at.x_by_t[i], at.y_by_t[i]);
    const float twice = 2 * by_s.dot(by_t), apart = by_s.length2() - by_t.length2(),
                both = std::sqrt(twice * twice + apart * apart),
                cosine = both > 0 ? apart / both : 1;  // of twice the angle of the largest stretch
    const V2f along(std::sqrt((1 + cosine) / 2), std::copysign(std::sqrt((1 - cosine) / 2), twice)),
        across(-along.y, along.x);
    Shape out{middle, V2f(0.f), V2f(0.f), 4, true, 0};
    const auto cut = [&](V2f axis, V2f& by) {
        const V2f image = by_s * axis.x + by_t * axis.y;
        const float stretch = image.length(), span = half * (std::fabs(axis.x) + std::fabs(axis.y));
        float low = -span, high = span;
        if (stretch > 0) {
            const float at_0 = -(at.x[i] * image.x + at.y[i] * image.y) / (stretch * stretch);
            low = std::max(low, at_0 - wide / stretch),
            high = std::min(high, at_0 + wide / stretch);
        }
        by = axis * ((high - low) / 2);
        out.middle += axis * ((high + low) / 2);
        out.area *= std::max(0.f, (high - low) / 2);
    };
    cut(along, out.by_x);
    cut(across, out.by_y);
    return out;
}

/// Eight squares, with the curvature of the landing there and the distance that counts as on the
/// target.
struct StopRegion::Eight {
    f8 s, t, bend, reach;
    Landings at;
    int count;

    void put(float x, float y, float curvature, float distance) {
        s[count] = x, t[count] = y, bend[count] = curvature, reach[count] = distance;
        ++count;
    }
    void put(const Eight& o, int i) {
        const auto copy = [&](f8& to, const f8& from) { to[count] = from[i]; };
        copy(at.x, o.at.x), copy(at.y, o.at.y);
        copy(at.x_by_s, o.at.x_by_s), copy(at.y_by_s, o.at.y_by_s);
        copy(at.x_by_t, o.at.x_by_t), copy(at.y_by_t, o.at.y_by_t);
        put(o.s[i], o.t[i], o.bend[i], o.reach[i]);
    }
    [[nodiscard]] V2f middle(int i) const { return {s[i], t[i]}; }
};

/// Squares of one size that may hold a point of the region.
class StopRegion::Squares {
  public:
    /// Takes those of eight, whose landings are there, that may hold one.
    void take(const Eight& eight, float half, uint64_t& of_map) {
        const f8 wide = eight.reach + eight.bend * (half * half);
        const m8 kept = eight.at.may_be_near(half, wide) & (eight.reach > 0.f);
        if (!any(kept)) return;
        for (int i = 0; i < eight.count; ++i) {
            if (!kept[i]) continue;
            of_map |= uint64_t{1} << StopMap::square(eight.middle(i));
            if (count_ == 0 || eights_[count_ - 1].count == 8) eights_[count_++] = Eight();
            eights_[count_ - 1].put(eight, i);
        }
    }
    void clear() { count_ = 0; }
    [[nodiscard]] std::span<const Eight> eights() const { return {eights_.data(), count_}; }

  private:
    std::array<Eight, kMost / 8> eights_;
    size_t count_ = 0;
};

// Ellipses are added by Newton's method, all squares at once. Squares that are left are returned,
// with the strip of each where the landing is straight there.
size_t StopRegion::find(const LandingMap& map, const Eight& eight, float half, LeftSquare* left) {
    const float across = half * kRoot2;
    Landings now = eight.at;
    const f8 least = now.stretch()[1];
    f8 s = eight.s, t = eight.t;
    const m8 smooth = (eight.bend * across < kSmooth * least) & (eight.reach > 0.f);
    std::array<bool, 8> found{};
    if (any(smooth)) {
        for (int step = 0; step < kSteps; ++step) {
            const f8 det = now.x_by_s * now.y_by_t - now.x_by_t * now.y_by_s;
            ++evaluations_;
            s -= (now.y_by_t * now.x - now.x_by_t * now.y) / det;
            t -= (now.x_by_s * now.y - now.y_by_s * now.x) / det;
            now = landings(map, s, t);
        }
        const m8 there = smooth & (now.x * now.x + now.y * now.y < kThere * kThere);
        for (int i = 0; i < eight.count; ++i) {
            // A way that lies elsewhere says nothing of this square.
            const V2f way(s[i], t[i]);
            const float away = (way - eight.middle(i)).length();
            if (there[i] && away < 2 * across + 1.5f * eight.reach[i] / least[i])
                found[size_t(i)] = add_ellipse(map, way, now, i, eight.reach[i], eight.bend[i]);
        }
    }
    size_t lefts = 0;
    for (int i = 0; i < eight.count; ++i) {
        if (found[size_t(i)]) continue;
        const float bent = eight.bend[i] * half * half;
        LeftSquare& out = left[lefts];
        out.middle = eight.middle(i), out.strip.area = 0;
        if (bent < kBentStrip * eight.reach[i]) {
            out.strip = strip(out.middle, half, eight.at, i, eight.reach[i] + bent);
            if (!(out.strip.area > 0)) continue;
        }
        ++lefts;
    }
    return lefts;
}

// Squares that may hold a point of the region are divided until Newton's method finds the way
// through each, or the landing is straight there.
StopRegion::StopRegion(const StopMap& map, const StopMap::Rays& rays, const ListedTarget& target,
                       float wider) {
    const LandingMap landing(rays, target);
    const auto [place, slope] = std::pair(target.most.x, target.most.y);
    const auto reach_of = [&](size_t n) {
        const V2f error = map.error(n);
        return 1 + place * error.x + slope * error.y + wider;
    };
    std::array<LeftSquare, kMost> left;
    size_t lefts = 0;
    float half = 1.f / StopMap::kSquares;
    Squares kept;
    Eight eight{};
    const auto land = [&] {
        eight.at = landings(landing, eight.s, eight.t);
        ++evaluations_;
    };
    const auto take = [&] {
        if (eight.count > 0) kept.take(eight, half, squares_);
        eight = Eight();
    };
    for (uint64_t bits = target.squares; bits != 0; bits &= bits - 1) {
        const auto n = static_cast<size_t>(std::countr_zero(bits));
        const V2f middle = StopMap::middle_of(n), bend = map.bend(n);
        eight.put(middle.x, middle.y, place * bend.x + slope * bend.y, reach_of(n));
        if (eight.count < 8 && (bits & (bits - 1)) != 0) continue;
        land();
        take();
    }
    for (const Eight& squares : kept.eights()) lefts += find(landing, squares, half, &left[lefts]);
    while (lefts > 0) {
        const size_t ellipses = count_;
        std::array<V2f, kMost / 4> divided;
        size_t count = 0;
        for (size_t i = 0; i < lefts; ++i) {
            const V2f middle = left[i].middle;
            if (is_covered(middle, half, ellipses)) continue;
            if (left[i].strip.area > 0)
                add(left[i].strip);
            else if (4 * lefts > kMost)
                add({middle, V2f(half, 0), V2f(0, half), 4 * half * half, true, 0});  // coarse
            else
                divided[count++] = middle;
        }
        half /= 2;
        lefts = 0;
        kept.clear();
        for (size_t first = 0; first < count; first += 2) {
            for (size_t i = first; i < std::min(first + 2, count); ++i)
                for (int k = 0; k < 4; ++k) {
                    const V2f middle = divided[i] + V2f(k & 1 ? half : -half, k & 2 ? half : -half);
                    const size_t n = StopMap::square(middle);
                    const bool on_disc = middle.length() - half * kRoot2 < 1;
                    eight.put(middle.x, middle.y, 0,
                              on_disc && target.squares >> n & 1 ? reach_of(n) : 0);
                }
            land();
            eight.bend = kBendMargin * eight.at.curvature(2 * half);
            take();
        }
        for (const Eight& squares : kept.eights())
            lefts += find(landing, squares, half, &left[lefts]);
    }
}

// One shape may cover it from corner to corner.
bool StopRegion::is_covered(V2f middle, float half, size_t by_first) const {
    for (size_t k = 0; k < by_first; ++k) {
        const Shape& shape = shapes_[k];
        bool all = !shape.is_square;
        for (const V2f& to : {V2f(-1, -1), V2f(1, -1), V2f(-1, 1), V2f(1, 1)})
            all = all && shape.contains(middle + to * half);
        if (all) return true;
    }
    return false;
}

V2f StopRegion::sample(float pick, V2f on) const {
    const float of_ellipses = chance(false);
    const bool is_square = !(pick < of_ellipses);
    float left =
        areas_[is_square] * (is_square ? (pick - of_ellipses) / chance(true) : pick / of_ellipses);
    size_t i = 0, last = 0;
    for (; i < count_; ++i) {
        if (shapes_[i].is_square != is_square) continue;
        last = i;
        if (left < shapes_[i].area) break;
        left -= shapes_[i].area;
    }
    i = last;
    const Shape& shape = shapes_[i];
    const V2f u = shape.is_square ? on * 2.f - V2f(1.f) : uniform_disk(on);
    return shape.middle + shape.by_x * u.x + shape.by_y * u.y;
}

float StopRegion::density(V2f s) const {
    std::array<int, 2> covers{};
    for (size_t i = 0; i < count_; ++i) covers[shapes_[i].is_square] += shapes_[i].contains(s);
    float out = 0;
    for (const bool is_square : {false, true})
        if (covers[is_square] > 0)
            out += chance(is_square) * static_cast<float>(covers[is_square]) / areas_[is_square];
    return out;
}

// The axes are those of a landing at `reach` in the map.
void StopRegion::correct(size_t ellipse, V2f landing) {
    Shape& shape = shapes_[ellipse];
    const float reach = kCorrectedReach + shape.bent, share = reach / shape.reach;
    shape.middle -= (shape.by_x * landing.x + shape.by_y * landing.y) / shape.reach;
    shape.by_x *= share, shape.by_y *= share;
    areas_[0] += shape.area * (share * share - 1);
    shape.area *= share * share;
    shape.reach = reach;
}

}  // namespace petzval::camera
