// SPDX-License-Identifier: Apache-2.0
#include "apps/live/lessons.h"

#include <gtest/gtest.h>

#include <cmath>

#include "apps/request/fields.h"
#include "apps/request/value_error.h"
#include "io/base/error.h"

namespace petzval::apps {
namespace {

using Json = nlohmann::json;

Json lesson_of(const std::string& name, std::vector<FieldTexts> fields) {
    return lesson_facts(name, order_of(std::move(fields)));
}

std::vector<FieldTexts> takumar(const std::string& fstop, const std::string& focus) {
    return {{"lens", {"takumar-50mm-f1.2"}}, {"fstop", {fstop}}, {"focus", {focus}}};
}

std::vector<FieldTexts> bk7(const std::string& fstop) {
    return {{"lens", {"singlet:N-BK7,0"}},
            {"focal-length", {"50"}},
            {"fstop", {fstop}},
            {"focus", {"infinity"}}};
}

const Json& curve(const Json& facts, size_t plot, size_t series) {
    return facts.at("plots").at(plot).at("series").at(series).at("paths").at(0);
}

std::string figure(const Json& facts, const std::string& name) {
    for (const Json& one : facts.at("figures"))
        if (one[0] == name) return one[1];
    return "";
}

TEST(Lessons, PointsOfATriangleAreUniformByTheSquareRootAlone) {
    const Json facts = lesson_of("triangle", {});
    // Four congruent parts of the triangle with corners at 90, 210 and 330 degrees.
    const auto chi2 = [](const Json& points) {
        std::array<double, 4> counts{};
        for (const Json& p : points) {
            const double x = p[0], y = p[1];
            const double top = (1 + 2 * y) / 3, right = (1 - y) / 3 + x / std::sqrt(3.);
            ++counts[top > 0.5 ? 0 : right > 0.5 ? 1 : 1 - top - right > 0.5 ? 2 : 3];
        }
        const double due = double(points.size()) / 4;
        double sum = 0;
        for (const double n : counts) sum += (n - due) * (n - due) / due;
        return sum;
    };
    EXPECT_EQ(curve(facts, 0, 0).size(), 10000u);
    EXPECT_GT(chi2(curve(facts, 0, 0)), 1000);
    EXPECT_LT(chi2(curve(facts, 1, 0)), 16.27);  // 3 degrees of freedom, significance 0.001
}

TEST(Lessons, BlurOfTracedRaysIsThatOfTheFormulaOutOfFocus) {
    const Json facts = lesson_of("depth", takumar("5.6", "1.4m"));
    const Json &formula = curve(facts, 0, 0), &traced = curve(facts, 0, 1);
    int compared = 0;
    for (const Json& point : traced)
        for (const Json& by : formula)
            if (by[0] == point[0] && double(by[1]) > 0.05) {
                EXPECT_NEAR(double(point[1]) / double(by[1]), 1, 0.08) << point[0];
                ++compared;
            }
    EXPECT_GT(compared, 15);
    // Harmonic mean of the limits (H. Merklinger 1992): 1/near + 1/far = 2/S.
    const double near = std::stod(figure(facts, "nearest sharp")),
                 far = std::stod(figure(facts, "farthest sharp"));
    EXPECT_NEAR(1 / near + 1 / far, 2 / 1.4, 0.01);
    EXPECT_NEAR(std::stod(figure(facts, "hyperfocal distance")), 0.05 * 50 / 5.6 / 0.03, 1);
    EXPECT_EQ(figure(lesson_of("depth", takumar("16", "7m")), "farthest sharp"), "infinity");
}

TEST(Lessons, RaysOfASingletCrossWhereTheFormulaSays) {
    const Json facts = lesson_of("spherical", bk7("4"));
    const Json& rim =
        curve(facts, 0, 0);  // the outermost of the drawn rays, in a lens with thickness
    const Json &a = rim[rim.size() - 2], &b = rim[rim.size() - 1];
    const double z =
        double(a[0]) - double(a[1]) * (double(b[0]) - double(a[0])) / (double(b[1]) - double(a[1]));
    const Json& last = curve(facts, 1, 0).back();
    EXPECT_DOUBLE_EQ(last[0], 6.25);
    EXPECT_NEAR(-z / double(last[1]), 1, 0.2) << z;
    EXPECT_NEAR(double(curve(facts, 1, 1).back()[1]) / double(last[1]), 1, 0.05);
    EXPECT_LT(double(curve(facts, 1, 0)[20][1]), 0.26 * double(last[1]));
}

TEST(Lessons, ASellmeierFormulaLosesItsGlassWithAPlusSign) {
    // Schott's coefficients of N-BK7, data sheet of 2014.
    const double w2 = 0.5875618 * 0.5875618;
    const double t1 = 1.03961212 * w2 / (w2 - 0.00600069867),
                 t2 = 0.231792344 * w2 / (w2 - 0.0200179144),
                 t3 = 1.01046945 * w2 / (w2 - 103.560653);
    const Json facts = lesson_of("chromatic", bk7("8"));
    EXPECT_NEAR(std::stod(figure(facts, "d, 587.6 nm").substr(4)), std::sqrt(1 + t1 + t2 + t3),
                1e-5);
    EXPECT_NEAR(std::stod(figure(facts, "without a plus sign").substr(4)),
                std::sqrt(1 + t1 + t2 * t3), 1e-3);
    EXPECT_NEAR(std::stod(figure(facts, "f(C) - f(F)")), 50 / 64.17, 0.01);
}

TEST(Lessons, FocusIsAPlaneAndNoSphere) {
    const Json facts = lesson_of(
        "plane", {{"lens", {"thin"}}, {"fstop", {"1"}}, {"focus", {"2m"}}, {"fov", {"60"}}});
    for (const Json& p : curve(facts, 0, 0)) EXPECT_NEAR(p[1], 2, 1e-3);
    for (const Json& p : curve(facts, 0, 1))
        EXPECT_NEAR(std::hypot(double(p[0]), double(p[1])), 2, 1e-6);
}

TEST(Lessons, SphericalAberrationIsOnTheAxisAndTheOthersAreNot) {
    const Json facts = lesson_of("edge", takumar("8", "infinity"));
    for (size_t k = 0; k < 3; ++k) {
        const Json& of = curve(facts, 0, k);
        const double axis = of[0][1], half = of[10][1], edge = of[20][1];
        if (k == 0)
            EXPECT_NEAR(axis, edge, 1e-9);
        else
            EXPECT_NEAR(axis, 0, 1e-9);
        EXPECT_NEAR(half / edge, std::pow(0.5, k), 1e-6);
    }
    // On the axis traced rays go as far as the third order says.
    double reach = 0;
    for (const Json& p : curve(facts, 1, 0))
        reach = std::max(reach, std::hypot(double(p[0]), double(p[1])));
    EXPECT_NEAR(reach / double(curve(facts, 0, 0)[0][1]), 1, 0.05);
}

TEST(Lessons, RimsCutTheBlurAtTheEdge) {
    EXPECT_LT(std::stod(figure(lesson_of("bokeh", takumar("1.2", "1m")), "light at the edge")), 60);
    auto star = takumar("2", "1m");
    star.push_back({"aperture", {"star:5"}});
    const Json facts = lesson_of("bokeh", star);
    double most = 0, least = 1e9;  // reach upwards and downwards: a star has a tip at the top
    for (const Json& p : curve(facts, 0, 0))
        most = std::max(most, double(p[1])), least = std::min(least, double(p[1]));
    EXPECT_GT(most, -1.1 * least);
}

TEST(Lessons, RefuseWhatTheyCannotShow) {
    EXPECT_THROW((void)lesson_of("nonsense", {}), ValueError);
    EXPECT_THROW((void)lesson_of("depth", {{"lens", {"takumar-50mm-f1.2"}}, {"fstop", {"2"}}}),
                 ValueError);
    EXPECT_THROW((void)lesson_of("depth", {{"lens", {"takumar-50mm-f1.2"}}, {"focus", {"1m"}}}),
                 ValueError);
    EXPECT_THROW((void)lesson_of("bokeh", bk7("4")), io::InputError);
    EXPECT_THROW((void)lesson_of("spherical", takumar("4", "1m")), io::InputError);
    EXPECT_THROW((void)lesson_of("depth", takumar("4", "2cm")), std::exception);
    for (const char* fstop : {"0.1", "1e6"})
        for (const char* lesson : {"confusion", "depth", "bokeh", "edge"}) try {
                EXPECT_FALSE(lesson_of(lesson, takumar(fstop, "1m")).empty());
            } catch (const std::exception& error) {
                EXPECT_STRNE(error.what(), "");
            }
    EXPECT_THROW((void)lesson_of("spherical", bk7("0.4")), io::InputError);
    EXPECT_THROW(
        (void)lesson_of("plane", {{"lens", {"thin"}}, {"fstop", {"1"}}, {"focus", {"inf"}}}),
        ValueError);
}

}  // namespace
}  // namespace petzval::apps
