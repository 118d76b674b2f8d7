// SPDX-License-Identifier: Apache-2.0
#include "camera/iris/aperture.h"

#include <gmock/gmock.h>

#include <numbers>

#include "camera/iris/iris.h"
#include "tests/support/complaint.h"

namespace petzval::camera {
namespace {

using test::complaint;
using testing::HasSubstr;

TEST(Aperture, RoundnessOfOneIsTheCircle) {
    for (const int n : {3, 5, 9}) {
        const auto contour = regular_polygon(n, 5, 1).contours[0];
        for (size_t i = 0; i < contour.size(); ++i) {
            EXPECT_NEAR(contour[i].length(), 1, 2e-4);
            EXPECT_NEAR(((contour[i] + contour[(i + 1) % contour.size()]) / 2).length(), 1, 2e-4);
        }
    }
}

// The middle of a blade's edge stands where an arc of that curvature has it.
TEST(Aperture, RoundnessIsTheCurvatureOfTheBlades) {
    const double half = std::numbers::pi / 5, r = 1 / 0.4;
    const double sagitta = r - std::sqrt(r * r - std::pow(std::sin(half), 2));
    double nearest = HUGE_VAL;
    const Polygon polygon = regular_polygon(5, 0, 0.4);
    for (const V2d& p : polygon.contours[0])
        if (std::fabs(std::atan2(p.y, p.x) - std::numbers::pi / 2 - half) < 0.03)
            nearest = std::min(nearest, std::fabs(p.length() - std::cos(half) - sagitta));
    EXPECT_LT(nearest, 5e-4);
}

TEST(Aperture, PointsUpAndTurnsCounterClockwise) {
    EXPECT_NEAR((regular_polygon(5).contours[0][0] - V2d(0, 1)).length(), 0, 1e-15);
    EXPECT_NEAR((star(5).contours[0][0] - V2d(0, 1)).length(), 0, 1e-15);
    EXPECT_NEAR((regular_polygon(5, 90).contours[0][0] - V2d(-1, 0)).length(), 0, 1e-15);
    const Iris triangle(regular_polygon(3), 1);
    EXPECT_EQ(triangle.transmits({0, 1.4f}), 1.f);
    EXPECT_EQ(triangle.transmits({0, -1.4f}), 0.f);
    EXPECT_EQ(Iris(rhomboid(), 1).transmits({1.4f, 0.55f}), 1.f) << "leans to the right";
    EXPECT_EQ(Iris(rhomboid(), 1).transmits({-1.4f, 0.55f}), 0.f);
    const Iris turned(regular_polygon(3, 30), 1);  // its tip at 120 degrees
    EXPECT_EQ(turned.transmits({-0.7f, 1.2f}), 1.f);
    EXPECT_EQ(turned.transmits({0.7f, 1.2f}), 0.f);
}

TEST(Aperture, RefusesBladesOutOfRange) {
    EXPECT_THAT(complaint([] { (void)regular_polygon(2); }), HasSubstr("from 3 to 100"));
    EXPECT_THAT(complaint([] { (void)regular_polygon(101); }), HasSubstr("from 3 to 100"));
    EXPECT_THAT(complaint([] { (void)regular_polygon(6, NAN); }), HasSubstr("rotation"));
    for (const double roundness : {-0.1, 1.1, double{NAN}})
        EXPECT_THAT(complaint([&] { (void)regular_polygon(6, 0, roundness); }),
                    HasSubstr("roundness"));
    EXPECT_THAT(complaint([] { (void)star(2); }), HasSubstr("tips"));
}

TEST(PolygonFault, NamesTheVertex) {
    const auto of = [](std::vector<std::vector<V2d>> contours) {
        const auto fault = find_fault(Polygon{std::move(contours)});
        return fault ? fault->message : "none";
    };
    const std::vector<V2d> box{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    EXPECT_EQ(of({box}), "none");
    EXPECT_THAT(of({}), HasSubstr("no contour"));
    EXPECT_THAT(of({{{0, 0}, {1, 0}}}), HasSubstr("contour 1: has 2 vertices"));
    EXPECT_THAT(of({{{0, 0}, {1, 1}, {1, 0}, {0, 1}}}),
                HasSubstr("contour 1, vertex 1 at (0, 0): the edge from here meets the edge from "
                          "vertex 3 of contour 1"));
    EXPECT_THAT(of({box, {{0, 0}, {3, 0}, {0, 0.5}}}),
                HasSubstr("contour 1, vertex 2 at (1, -1): the edge from here meets the edge from "
                          "vertex 1 of contour 2"));
    EXPECT_THAT(of({box, {{1, 0}, {3, 0}, {3, 0.5}}}), HasSubstr("meets")) << "touches";
    EXPECT_THAT(of({box, box}), HasSubstr("meets"));
    EXPECT_THAT(of({{{0, 0}, {1, 0}, {1, 0}, {0, 1}}}),
                HasSubstr("vertex 2 at (1, 0): stands on the next"));
    EXPECT_THAT(of({{{0, 0}, {2, 0}, {1, 0}, {1, 1}}}),
                HasSubstr("vertex 2 at (2, 0): the contour turns back"));
    EXPECT_THAT(of({{{0, 0}, {1, 0}, {2, 0}}}), HasSubstr("vertex 1 at (0, 0): the contour turns"));
    EXPECT_THAT(of({{{0, 0}, {1, NAN}, {0, 1}}}), HasSubstr("vertex 2 at (1, nan): coordinates"));
    EXPECT_THAT(of({{{0, 0}, {2e9, 0}, {0, 1}}}), HasSubstr("vertex 2"));
    EXPECT_THAT(of({std::vector<V2d>(10001, V2d(0))}), HasSubstr("over 10000"));
    EXPECT_THAT(complaint([] {
                    (void)Iris(Polygon{{{{0, 0}, {1, 1}, {1, 0}, {0, 1}}}}, 1);
                }),
                HasSubstr("vertex 1"));
}

TEST(PolygonFault, OfMasks) {
    EXPECT_THAT(*find_fault(Mask{2, 2, {0, 0, 0, 0}}), HasSubstr("black everywhere"));
    EXPECT_THAT(*find_fault(Mask{2, 2, {1, 1, 1}}), HasSubstr("texels"));
    EXPECT_THAT(*find_fault(Mask{0, 2, {}}), HasSubstr("texels"));
    EXPECT_THAT(*find_fault(Mask{2, 1, {1, NAN}}), HasSubstr("column 1, row 0"));
    EXPECT_THAT(*find_fault(Mask{1, 2, {1, 1.5f}}), HasSubstr("column 0, row 1"));
    EXPECT_FALSE(find_fault(Mask{2, 1, {0, 1}}));
    EXPECT_THAT(complaint([] { (void)Iris(Mask{1, 1, {0}}, 1); }), HasSubstr("black"));
}

}  // namespace
}  // namespace petzval::camera
