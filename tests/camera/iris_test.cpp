// SPDX-License-Identifier: Apache-2.0
#include "camera/iris/iris.h"

#include <gmock/gmock.h>

#include <map>
#include <numbers>

#include "core/sampling/sampler.h"
#include "tests/support/chi_square.h"
#include "tests/support/clip.h"
#include "tests/support/complaint.h"

namespace petzval::camera {
namespace {

using enum IrisSampling;
using test::complaint;
using test::Random;
using testing::HasSubstr;

constexpr double kStop_mm = 7.25;
constexpr double kGolden = 0.3819660112501051;  // (3 - sqrt 5) / 2

// 1 wide, at 45 degrees.
Polygon sliver(double length = 1000) {
    const V2d along = V2d(length / 2) / std::sqrt(2.0), across = V2d(-0.5, 0.5) / std::sqrt(2.0);
    return {{{-along - across, along - across, along + across, across - along}}};
}

// An L with a slot in it: neither convex nor a star.
Polygon elbow() {
    return {{{{-1, -1}, {1, -1}, {1, -0.25}, {-0.25, 0.1}, {-0.3, 1.5}, {-1, 1}},
             {{-0.9, -0.9}, {-0.8, 0.8}, {-0.5, 0.8}, {-0.6, -0.6}}}};
}

std::map<std::string, Polygon> polygons() {
    return {{"square", square()},
            {"rhomboid", rhomboid()},
            {"frame", frame()},
            {"triangle", regular_polygon(3)},
            {"star:5", star(5)},
            {"star:12", star(12)},
            {"hexagon", regular_polygon(6, 10)},
            {"nine blades", regular_polygon(9, -20, 0.5)},
            {"rounded triangle", regular_polygon(3, 0, 1)},
            {"elbow", elbow()},
            {"sliver", sliver()}};
}

Mask wedge() {
    Mask mask{6, 4, {}};
    for (int i = 0; i < 24; ++i) mask.texels.push_back(i % 5 ? static_cast<float>(i) / 40 : 0.f);
    return mask;
}

std::map<std::string, ApertureShape> shapes() {
    std::map<std::string, ApertureShape> out{{"circle", Disk()}, {"mask", wedge()}};
    for (const auto& [name, polygon] : polygons()) out[name] = polygon;
    return out;
}

Polygon scaled(Polygon polygon, double by) {
    for (auto& contour : polygon.contours)
        for (V2d& p : contour) p *= by;
    return polygon;
}

double area_of(const Polygon& polygon) {
    return test::area_in(polygon, -1e4, 1e4, -1e4, 1e4);
}

// Counts in a grid over the polygon's box against the polygon clipped to each cell.
testing::AssertionResult uniform_over(const Polygon& polygon, const Iris& iris, uint32_t seed,
                                      int samples = 200000, int cells = 24) {
    const Polygon mm = scaled(polygon, std::sqrt(std::numbers::pi / area_of(polygon)) * kStop_mm);
    V2d low(1e9), high(-1e9);
    for (const auto& contour : mm.contours)
        for (const V2d& p : contour) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
    const V2d size = (high - low) / cells;
    const double area = area_of(mm);
    std::vector<double> expected, observed(cells * cells);
    for (int i = 0; i < cells * cells; ++i) {
        const double x = low.x + i % cells * size.x, y = low.y + i / cells * size.y;
        expected.push_back(samples * test::area_in(mm, x, x + size.x, y, y + size.y) / area);
    }
    Random random(seed);
    for (int i = 0; i < samples; ++i) {
        const V2f p = iris.sample(random.next2());
        const int column = static_cast<int>((p.x - low.x) / size.x);
        const int row = static_cast<int>((p.y - low.y) / size.y);
        ++observed[std::clamp(row, 0, cells - 1) * cells + std::clamp(column, 0, cells - 1)];
    }
    return test::chi_square(observed, expected);
}

TEST(Iris, DrawsPolygonsUniformly) {
    uint32_t seed = 1;
    for (const auto& [name, polygon] : polygons())
        for (const IrisSampling way : iris_samplings(polygon)) {
            const Iris iris(polygon, kStop_mm, ApertureScale::EqualArea, way);
            EXPECT_TRUE(uniform_over(polygon, iris, ++seed)) << name << ", way " << int(way);
        }
}

TEST(Iris, DrawsTheCircleUniformly) {
    const auto density = [](double radius, double) { return 2 * radius; };
    for (const IrisSampling way : {Formula, Rejection}) {
        const Iris iris(Disk(), kStop_mm, ApertureScale::EqualArea, way);
        const auto place = [&](Random& random) -> std::optional<V2f> {
            const V2f p = iris.sample(random.next2()) / static_cast<float>(kStop_mm);
            return V2f(p.length(), atan2_turns(p.y, p.x) + 0.5f);
        };
        EXPECT_TRUE(test::chi_square_grid({0, 1, 0, 1, 20, 40}, density, place, 200000, 50));
    }
    EXPECT_EQ(Iris(Disk(), 2).sample({0.5f, 0.5f}), V2f(0));
}

TEST(Iris, DrawsMasksInProportionToTheirGrey) {
    const Mask mask = wedge();
    const double sum = std::accumulate(mask.texels.begin(), mask.texels.end(), 0.0);
    for (const IrisSampling way : {Formula, Rejection}) {
        const Iris iris(mask, kStop_mm, ApertureScale::EqualArea, way);
        const double texel = kStop_mm * std::sqrt(std::numbers::pi / sum);
        const auto density = [&](double x, double y) {  // row 0 at the top
            return mask.texels[(3 - static_cast<int>(y)) * 6 + static_cast<int>(x)] / sum;
        };
        const auto place = [&](Random& random) -> std::optional<V2f> {
            return iris.sample(random.next2()) / static_cast<float>(texel) + V2f(3, 2);
        };
        EXPECT_TRUE(test::chi_square_grid({0, 6, 0, 4, 24, 16}, density, place, 200000, 60));
        for (int i = 0; i < 24; ++i)
            EXPECT_EQ(iris.transmits({static_cast<float>((i % 6 - 2.6) * texel),
                                      static_cast<float>((1.6 - i / 6) * texel)}),
                      mask.texels[i]);
        EXPECT_EQ(iris.transmits({static_cast<float>(3.01 * texel), 0}), 0.f);
    }
}

// Along the sliver every point is as likely, and across it too: 25 squares a side hide that.
TEST(Iris, DrawsTheSliverUniformlyAcross) {
    const double unit_mm = kStop_mm * std::sqrt(std::numbers::pi / 1000);
    for (const IrisSampling way : {Formula, Triangles, Rejection}) {
        const Iris iris(sliver(), kStop_mm, ApertureScale::EqualArea, way);
        const auto place = [&](Random& random) -> std::optional<V2f> {
            const V2f p = iris.sample(random.next2());
            const double along = (double{p.x} + p.y) / std::sqrt(2.0) / unit_mm;
            const double across = (double{p.y} - p.x) / std::sqrt(2.0) / unit_mm;
            return V2f(static_cast<float>(along / 1000 + 0.5), static_cast<float>(across + 0.5));
        };
        const auto density = [](double, double) { return 1.0; };
        EXPECT_TRUE(test::chi_square_grid({0, 1, 0, 1, 40, 20}, density, place, 200000, 70))
            << int(way);
    }
}

// A third of these points use up their tries. The points u that are accepted at once are those that
// the formula lays on the sliver's own diagonal: drawing u again at the end would leave it thin.
TEST(Iris, RejectionEndsWithAFreshPoint) {
    constexpr double length = 500, mm = 1;
    const double unit_mm = std::sqrt(std::numbers::pi / length) * mm;
    const Iris iris(sliver(length), mm, ApertureScale::EqualArea, Rejection);
    Random random(75);
    test::Moments on_diagonal;
    for (int i = 0; i < 200000; ++i) {
        const V2f p = iris.sample(random.next2());
        const double along = (double{p.x} + p.y) / std::sqrt(2.0) / unit_mm / length;
        const double across = (double{p.y} - p.x) / std::sqrt(2.0) / unit_mm;
        on_diagonal.add(std::fabs(along - across) < 1 / length);
    }
    const double share = 2 / length - 1 / (length * length);
    EXPECT_TRUE(test::agrees(on_diagonal, share)) << on_diagonal.mean() << ", not " << share;
}

TEST(Iris, LetsThroughWhatTheFNumberSays) {
    Random random(80);
    for (const auto& [name, shape] : shapes()) {
        const Iris iris(shape, kStop_mm);
        const double round = std::numbers::pi * kStop_mm * kStop_mm;
        EXPECT_NEAR(iris.area_mm2(), round, 1e-9 * round) << name;
        test::Moments passed;
        const float reach = iris.bounding_radius_mm();
        for (int i = 0; i < 200000; ++i)
            passed.add(iris.transmits((random.next2() * 2.f - V2f(1)) * reach));
        const double box = 4.0 * reach * reach;
        EXPECT_TRUE(test::agrees(passed, round / box))
            << name << ": " << passed.mean() * box << " mm2, not " << round;
    }
}

TEST(Iris, InscribedReachesTheStopAndNoFarther) {
    for (const auto& [name, shape] : shapes()) {
        const Iris iris(shape, kStop_mm, ApertureScale::Inscribed);
        EXPECT_FLOAT_EQ(iris.bounding_radius_mm(), static_cast<float>(kStop_mm)) << name;
        EXPECT_EQ(iris.share_beyond(kStop_mm * (1 + 1e-6)), 0) << name;
        EXPECT_GT(iris.share_beyond(kStop_mm * 0.999), 0) << name;
        Random random(81);
        for (int i = 0; i < 10000; ++i)
            ASSERT_LE(iris.sample(random.next2()).length(), kStop_mm * (1 + 1e-6)) << name;
    }
}

// Inscribed in the unit circle, an area is that of the shape with its farthest point at 1.
TEST(Iris, AreasInClosedForm) {
    const auto area = [](const Polygon& p) {
        return Iris(p, 1, ApertureScale::Inscribed).area_mm2();
    };
    EXPECT_NEAR(area(square()), 2, 1e-12);
    EXPECT_NEAR(area(frame()), 1.5, 1e-12);
    EXPECT_NEAR(area(rhomboid()), 2 / (1.25 * 1.25 + 0.25), 1e-12);
    EXPECT_NEAR(area(regular_polygon(3)), 3 * std::sqrt(3.0) / 4, 1e-12);
    EXPECT_NEAR(area(sliver()), 1000 / (500 * 500 + 0.25), 1e-12);
    for (const int n : {3, 5, 8, 100})
        EXPECT_NEAR(area(star(n)), n * kGolden * std::sin(std::numbers::pi / n), 1e-12) << n;
    for (const int n : {3, 4, 7, 11, 100})
        for (const double roundness : {0.0, 0.01, 0.3, 0.8, 1.0}) {
            double exact = n * std::sin(2 * std::numbers::pi / n) / 2;
            if (roundness > 0) {  // a circular segment on each edge
                const double r = 1 / roundness,
                             half = std::asin(std::sin(std::numbers::pi / n) / r);
                exact += n * r * r * (half - std::sin(half) * std::cos(half));
            }
            // The polyline reaches a little beyond the arcs, which its scale takes back.
            const Polygon p = regular_polygon(n, 33, roundness);
            EXPECT_NEAR(area_of(p), exact, 1e-5 * exact) << n << ", " << roundness;
            EXPECT_NEAR(area(p), exact, 4e-4 * exact) << n << ", " << roundness;
        }
}

TEST(Iris, TipsOfAStarReachBeyondTheStop) {
    // sqrt(pi / (5 * 0.381966 * sin 36 deg))
    EXPECT_NEAR(Iris(star(5), kStop_mm).bounding_radius_mm() / kStop_mm, 1.67289, 1e-5);
    // The inner vertices of the pentagram lie on the lines from tip to next tip but one.
    const auto tips = star(5).contours[0];
    EXPECT_NEAR((tips[4] - tips[0]).cross(tips[1] - tips[0]), 0, 1e-15);
}

TEST(Iris, TellsInsideFromOutside) {
    for (const auto& [name, polygon] : polygons()) {
        const Iris iris(polygon, kStop_mm);
        const Polygon mm =
            scaled(polygon, std::sqrt(std::numbers::pi / area_of(polygon)) * kStop_mm);
        const float reach = iris.bounding_radius_mm();
        Random random(90);
        const auto check = [&](V2f p) {
            if (test::distance_to_edge(mm, V2d(p)) < 2e-6 * reach) return;
            ASSERT_EQ(iris.transmits(p) > 0, test::turns_about(mm, V2d(p)) != 0)
                << name << " at " << p.x << ", " << p.y;
        };
        for (int i = 0; i < 5000; ++i) check((random.next2() * 2.2f - V2f(1.1f)) * reach);
        for (int i = 0; i < 5000; ++i) {  // close to the edges
            const auto& contour = mm.contours[i % mm.contours.size()];
            const size_t k = static_cast<size_t>(random.next() * contour.size());
            const V2d on = contour[k] + (contour[(k + 1) % contour.size()] - contour[k]) *
                                            static_cast<double>(random.next());
            const V2d away = V2d(random.next2() * 2.f - V2f(1)) * 1e-4 * reach;
            check({static_cast<float>(on.x + away.x), static_cast<float>(on.y + away.y)});
        }
    }
}

TEST(Iris, SamplesAreInside) {
    for (const auto& [name, shape] : shapes())
        for (const IrisSampling way : iris_samplings(shape)) {
            const Iris iris(shape, kStop_mm, ApertureScale::EqualArea, way);
            Random random(91);
            int outside = 0;
            for (int i = 0; i < 100000; ++i)
                outside += iris.transmits(iris.sample(random.next2())) == 0;
            EXPECT_LE(outside, name == "sliver" ? 100 : 10) << name << ", way " << int(way);
        }
}

TEST(Iris, SampleIsAFunctionOfItsPoint) {
    for (const auto& [name, shape] : shapes())
        for (const IrisSampling way : iris_samplings(shape)) {
            const Iris iris(shape, 3, ApertureScale::EqualArea, way), again(shape, 3, {}, way);
            Random random(92);
            for (int i = 0; i < 1000; ++i) {
                const V2f u = random.next2();
                ASSERT_EQ(iris.sample(u), again.sample(u)) << name;
            }
            for (const V2f& u : {V2f(0, 0), V2f(kOneMinus, 0), V2f(0, kOneMinus), V2f(kOneMinus)})
                EXPECT_LE(iris.sample(u).length(), iris.bounding_radius_mm() * (1 + 1e-6f)) << name;
        }
}

// Variance of the share of 256 points on one side of a line, against that of independent points.
double variance_ratio(const Iris& iris) {
    double ratio = 0;
    Random random(93);
    for (const float turns : {0.03f, 0.1f, 0.21f, 0.4f}) {
        const SinCos along = sincos_turns(turns);
        test::Moments stratified, independent;
        for (uint32_t seed = 0; seed < 100; ++seed) {
            int above[2] = {};
            for (uint32_t i = 0; i < 256; ++i) {
                const V2f u = Sampler(SamplerKind::Owen, seed, {0, 0, i}).get2(Dim::Lens);
                const V2f p = iris.sample(u), q = iris.sample(random.next2());
                above[0] += p.x * along.sine > p.y * along.cosine;
                above[1] += q.x * along.sine > q.y * along.cosine;
            }
            stratified.add(above[0]), independent.add(above[1]);
        }
        ratio += stratified.variance() / independent.variance() / 4;
    }
    return ratio;
}

// Rejection begins with the point that it is given, so that a shape that fills half of its box
// keeps some of it; an alias table strews neighbours over the shape; the other ways use every bit.
TEST(Iris, KeepsStratification) {
    for (const auto& [name, shape] : shapes())
        for (const IrisSampling way : iris_samplings(shape)) {
            const double ratio = variance_ratio(Iris(shape, 1, ApertureScale::EqualArea, way));
            const bool fills_its_box = name == "circle" || name == "square" || name == "frame" ||
                                       name == "hexagon" || name == "nine blades";
            const double most = way == Alias       ? 0.4
                                : way != Rejection ? 0.12
                                : fills_its_box    ? 0.4
                                                   : 1.2;
            EXPECT_LT(ratio, most) << name << ", way " << int(way);
        }
}

TEST(Iris, ShareBeyondACircle) {
    // A square and a circle of one area: what one has outside the other, the other has outside it.
    const double half = std::sqrt(std::numbers::pi) / 2;
    const double segment = std::acos(half) - half * std::sqrt(1 - half * half);
    const Iris equal(square(), kStop_mm);
    EXPECT_NEAR(equal.share_beyond(kStop_mm), 4 * segment / std::numbers::pi, 1e-9);
    EXPECT_NEAR(Iris(square(), 1, ApertureScale::Inscribed).share_beyond(std::sqrt(0.5)),
                1 - std::numbers::pi / 4, 1e-9);
    EXPECT_NEAR(Iris(Disk(), 4).share_beyond(3), 1 - 9.0 / 16, 1e-12);
    EXPECT_NEAR(Iris(frame(), 1, ApertureScale::Inscribed).share_beyond(0.3), 1, 1e-9);
    EXPECT_EQ(equal.share_beyond(0), 1);
    EXPECT_EQ(equal.share_beyond(kStop_mm * 1.2534), 0);
    for (const auto& [name, shape] : shapes()) {
        const Iris iris(shape, kStop_mm);
        Random random(94);
        for (const double radius : {0.4 * kStop_mm, 0.8 * kStop_mm, 1.1 * kStop_mm}) {
            test::Moments beyond;
            for (int i = 0; i < 200000; ++i)
                beyond.add(iris.sample(random.next2()).length() > radius);
            if (beyond.variance() == 0)
                EXPECT_NEAR(iris.share_beyond(radius), beyond.mean(), 1e-4) << name;
            else
                EXPECT_TRUE(test::agrees(beyond, iris.share_beyond(radius)))
                    << name << ": " << beyond.mean() << ", not " << iris.share_beyond(radius);
        }
    }
}

// The pentagram's tips beyond the stop hold 24 % of its light.
TEST(Iris, ShareOfAStarBeyondItsStop) {
    const double reach =
        std::sqrt(std::numbers::pi / (5 * kGolden * std::sin(std::numbers::pi / 5)));
    // Half a tip: from the circle outwards between its axis and the edge, which runs at 18 degrees.
    double half_tip = 0;
    constexpr int steps = 200000;
    for (int i = 0; i < steps; ++i) {
        const double radius = 1 + (reach - 1) * (i + 0.5) / steps;
        const double edge =
            std::asin(reach * std::sin(std::numbers::pi / 10) / radius) - std::numbers::pi / 10;
        half_tip += radius * edge * (reach - 1) / steps;
    }
    EXPECT_NEAR(Iris(star(5), kStop_mm).share_beyond(kStop_mm), 10 * half_tip / std::numbers::pi,
                1e-8);
}

TEST(Iris, RulesForContoursInContours) {
    Polygon nested{{{{-2, -2}, {2, -2}, {2, 2}, {-2, 2}}, {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}}};
    EXPECT_EQ(Iris(nested, 1).transmits({0, 0}), 1.f);
    EXPECT_NEAR(Iris(nested, 1, ApertureScale::Inscribed).area_mm2(), 2, 1e-12);
    nested.even_odd = true;
    EXPECT_EQ(Iris(nested, 1).transmits({0, 0}), 0.f);
    EXPECT_NEAR(Iris(nested, 1, ApertureScale::Inscribed).area_mm2(), 1.5, 1e-12);
    EXPECT_TRUE(uniform_over(frame(), Iris(nested, kStop_mm), 95));
}

// What a rim cuts off is not drawn; what is left is drawn evenly, and keeps its brightness.
TEST(Iris, ARimCutsWhatLiesBeyond) {
    for (const auto& [name, shape] : shapes())
        for (const IrisSampling way : iris_samplings(shape)) {
            const Iris whole(shape, 1, ApertureScale::EqualArea, way);
            const double rim = 0.8 * double(whole.bounding_radius_mm());
            const double lost = whole.share_beyond(rim);
            const Iris cut(shape, 1, ApertureScale::EqualArea, way, rim);
            EXPECT_NEAR(cut.share_cut(), lost, 1e-12);
            if (lost == 0 || lost > 0.9) continue;
            EXPECT_NEAR(cut.area_mm2(), whole.area_mm2() * (1 - lost), 1e-9) << name;
            // Of two that halve the cut shape's points, each has the share that its area says.
            const double inner = 0.7 * rim;
            const double expected = (1 - whole.share_beyond(inner)) / (1 - lost);
            Random random(77);
            test::Moments inside;
            for (int i = 0; i < 40000; ++i) {
                const V2f p = cut.sample(random.next2());
                ASSERT_LE(p.length(), rim * (1 + 1e-6)) << name;
                inside.add(p.length() <= inner);
            }
            EXPECT_TRUE(test::agrees(inside, expected))
                << name << ", way " << int(way) << ": " << inside.mean() << ", not " << expected;
            EXPECT_EQ(cut.transmits({float(rim) * 1.01f, 0}), 0.f);
        }
}

TEST(Iris, RefusesWhatIsNotThere) {
    for (const double radius : {0.0, -1.0, 1e-30, double{NAN}, HUGE_VAL})
        EXPECT_THAT(complaint([&] { (void)Iris(Disk(), radius); }), HasSubstr("radius"));
    const auto with = [](const ApertureShape& shape, IrisSampling way) {
        return complaint([&] { (void)Iris(shape, 1, ApertureScale::EqualArea, way); });
    };
    EXPECT_THAT(with(star(5), Formula), HasSubstr("no formula"));
    EXPECT_THAT(with(Disk(), Triangles), HasSubstr("no triangles"));
    EXPECT_THAT(with(wedge(), Triangles), HasSubstr("no triangles"));
    EXPECT_EQ(Iris(star(5), 1).transmits({NAN, 0}), 0.f);
    EXPECT_EQ(Iris(wedge(), 1).transmits({0, NAN}), 0.f);
    EXPECT_EQ(Iris(Disk(), 1).transmits({NAN, NAN}), 0.f);
}

}  // namespace
}  // namespace petzval::camera
