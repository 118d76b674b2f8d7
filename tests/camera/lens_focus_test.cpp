// SPDX-License-Identifier: Apache-2.0
// Focus by traced rays against brute force over the place of the film or of the group.
#include "camera/lens/focus.h"

#include <gtest/gtest.h>

#include <cmath>

#include "camera/lens/paraxial.h"
#include "camera/lens/traced_ray.h"
#include "tests/support/lens_json.h"

namespace petzval::camera {
namespace {

Lens shipped(const char* name) {
    return Lens(test::read_any_lens(name));
}

/// Rays from an axial point on a square grid over the plane of the first vertex: nothing in common
/// with the code under test but the trace of one ray.
class BruteSpot {
  public:
    BruteSpot(const Lens& lens, double object_mm, int side) {
        const double reach = lens.prescription().surfaces[0].semi_diameter_mm;
        for (const double nm : {kLineF_nm, kLineD_nm, kLineC_nm}) {
            lines_.emplace_back();
            // One quarter: lenses are symmetric.
            for (int i = 0; i < side; ++i)
                for (int j = 0; j < side; ++j) {
                    const V3d at(reach * (i + 0.5) / side, reach * (j + 0.5) / side, 0);
                    const V3d along =
                        std::isfinite(object_mm) ? at - V3d(0, 0, object_mm) : V3d(0, 0, 1);
                    TracedRay ray = trace_ray(lens, at, along, nm, Towards::Film, Clip::Yes);
                    if (ray.status == RayStatus::Passed) lines_.back().push_back(std::move(ray));
                }
        }
    }
    /// By the definition.
    [[nodiscard]] double mean_square_mm2(double film_mm) const {
        double mean = 0;
        for (const auto& rays : lines_)
            for (const TracedRay& ray : rays) {
                const auto film = *ray.at_plane(film_mm);
                mean += (film[0] * film[0] + film[1] * film[1]) / double(3 * rays.size());
            }
        return mean;
    }

  private:
    std::vector<std::vector<TracedRay>> lines_;
};

/// The least of a parabola through three neighbours of the least of many.
double brute_minimum(double from, double to, const auto& f) {
    constexpr int steps = 16;
    double best = from, least = INFINITY;
    const double step = (to - from) / steps;
    for (int i = 1; i < steps; ++i)
        if (const double there = f(from + step * i); there < least) {
            least = there;
            best = from + step * i;
        }
    const double before = f(best - step), after = f(best + step);
    return best + step / 2 * (before - after) / (before - 2 * least + after);
}

double film_gap(const Prescription& p) {
    return p.surfaces.back().thickness_mm;
}
double film_gap(const Lens& lens) {
    return film_gap(lens.prescription());
}

TEST(LensFocus, TracedFilmIsWhereBruteForceFindsIt) {
    const struct {
        const char* lens;
        double object_mm, width_mm;
    } cases[] = {{"takumar-50mm-f1.2", -INFINITY, 0.4},
                 {"takumar-50mm-f1.2", -600, 0.6},
                 {"double-gauss-100mm-f2", -INFINITY, 0.8},
                 {"phone-f3.5-asph", -300, 0.05},
                 {"schneider-anamorphic-31mm", -4000, 1}};
    for (const auto& c : cases) {
        const Lens lens = shipped(c.lens);
        const Lens paraxial(*focused(lens, c.object_mm));
        const Lens traced(*focused(lens, c.object_mm, FocusBy::Traced));
        const BruteSpot spot(lens, c.object_mm, 120);
        const auto blur = [&](double shift_mm) {
            return spot.mean_square_mm2(paraxial.film_mm() + shift_mm);
        };
        const double wanted = brute_minimum(-c.width_mm, c.width_mm, blur);
        const double shift = traced.film_mm() - paraxial.film_mm();
        EXPECT_NEAR(shift, wanted, 0.01 * std::fabs(wanted)) << c.lens << ' ' << c.object_mm;
        EXPECT_LT(blur(shift), 0.95 * blur(0)) << c.lens;
    }
    // Undercorrected rays from the rim meet in front of the paraxial image.
    const Lens takumar = shipped("takumar-50mm-f1.2");
    EXPECT_LT(film_gap(*focused(takumar, -INFINITY, FocusBy::Traced)),
              film_gap(*focused(takumar, -INFINITY)) - 0.02);
}

TEST(LensFocus, TracedGroupIsWhereBruteForceFindsIt) {
    for (const char* name : {"kreitzer-telephoto-400mm-f5.6", "nikkor-400mm-f2.8-fl"})
        for (const double object_mm : {-double(INFINITY), -8000.}) {
            const Lens lens = shipped(name);
            const auto& group = *lens.prescription().focus_group;
            const Prescription paraxial = focused(lens, object_mm)->prescription();
            const Prescription traced = focused(lens, object_mm, FocusBy::Traced)->prescription();
            const size_t before = size_t(group[0] - 1), behind = size_t(group[1]);
            const auto by = [&](const Prescription& p) {
                return p.surfaces[before].thickness_mm - paraxial.surfaces[before].thickness_mm;
            };
            const auto blur = [&](double by_mm) {
                Prescription p = paraxial;
                p.surfaces[before].thickness_mm += by_mm;
                p.surfaces[behind].thickness_mm -= by_mm;
                const Lens there(p);
                return BruteSpot(there, object_mm, 40).mean_square_mm2(there.film_mm());
            };
            const double wanted = brute_minimum(-0.1, 0.1, blur);
            EXPECT_NEAR(by(traced), wanted, 0.02 * std::fabs(wanted) + 2e-4)
                << name << ' ' << object_mm;
            EXPECT_LT(blur(by(traced)), blur(0)) << name;
            // Nothing else moves.
            EXPECT_EQ(film_gap(traced), film_gap(paraxial));
            EXPECT_NEAR(Lens(traced).film_mm(), Lens(paraxial).film_mm(), 1e-9);
        }
}

// The patent's own figure: surfaces 11 to 15 move 15.27 mm for an object 2.6 m from the film.
TEST(LensFocus, TheGroupMovesAsThePatentSays) {
    const Lens lens = shipped("nikkor-400mm-f2.8-fl");
    const auto gap_mm = [](const Prescription& p) { return p.surfaces[10].thickness_mm; };
    const Prescription near = focused(lens, lens.film_mm() - 2600)->prescription();
    EXPECT_NEAR(gap_mm(near) - gap_mm(lens.prescription()), 15.27, 0.15);
}

// Through a narrow iris only colour is left of what moves the best spot: F and C are sharp
// elsewhere than d.
TEST(LensFocus, ANarrowIrisFocusesNearTheAxis) {
    for (const char* name : {"takumar-50mm-f1.2", "kreitzer-telephoto-400mm-f5.6"}) {
        const Lens lens = shipped(name);
        const double stop_mm = *stop_radius_for(lens, 64);
        const Prescription paraxial = focused(lens, -INFINITY)->prescription();
        double sum = 0, weights = 0;
        for (const double nm : {kLineF_nm, kLineD_nm, kLineC_nm}) {
            const FirstOrder f = first_order(Lens(paraxial), nm);
            const double slope = f.exit_pupil_diameter_mm / 2 / (f.back_focus_mm - f.exit_pupil_mm);
            sum += slope * slope * (f.back_focus_mm - film_gap(paraxial));
            weights += slope * slope;
        }
        const double colours = sum / weights;
        const auto shift = [&](double radius_mm) {
            const Lens sharp(paraxial);
            return *best_film_shift_mm(sharp, sharp.film_mm(), -INFINITY, radius_mm);
        };
        EXPECT_NEAR(shift(stop_mm), colours, 0.06 * std::fabs(shift(INFINITY) - colours)) << name;
        EXPECT_NEAR(shift(stop_mm / 2), colours, 0.3 * std::fabs(shift(stop_mm) - colours)) << name;
        EXPECT_EQ(shift(1e3), shift(INFINITY)) << name;  // the stop as filed is narrower
        const Prescription traced =
            focused(lens, -INFINITY, FocusBy::Traced, stop_mm)->prescription();
        for (size_t i = 0; i < traced.surfaces.size(); ++i)
            EXPECT_NEAR(traced.surfaces[i].thickness_mm, paraxial.surfaces[i].thickness_mm, 0.03)
                << name << ' ' << i;
        if (!lens.prescription().focus_group) {
            EXPECT_NEAR(film_gap(traced), film_gap(paraxial) + shift(stop_mm), 1e-9) << name;
        }
    }
}

/// Plano-hyperbolic, k = -n^2: all rays of a distant point meet in one. Descartes 1637, La
/// Dioptrique.
Prescription perfect_lens(bool with_group) {
    constexpr double n = 1.5, f_mm = 50;
    Prescription lens;
    lens.surfaces.resize(3);
    lens.surfaces[0].stop = true;
    for (auto& s : lens.surfaces) s.semi_diameter_mm = 15;
    lens.surfaces[0].thickness_mm = 1;
    lens.surfaces[1].thickness_mm = 8;
    lens.surfaces[1].glass = Glass{"n = 1.5", IndexSeries{{{n, 0}}}};
    lens.surfaces[2].curvature_1_mm = -1 / ((n - 1) * f_mm);
    lens.surfaces[2].conic = -n * n;
    lens.surfaces[2].thickness_mm = f_mm;
    if (with_group) lens.focus_group = {1, 2};
    return lens;
}

TEST(LensFocus, APerfectLensStaysWhereItIs) {
    for (const bool with_group : {false, true}) {
        const Lens lens(perfect_lens(with_group));
        const auto traced = focused(lens, -INFINITY, FocusBy::Traced);
        ASSERT_TRUE(traced);
        EXPECT_NEAR(film_gap(*traced), 50, 1e-6) << with_group;
        EXPECT_NEAR(traced->prescription().surfaces[0].thickness_mm, 1, 1e-6) << with_group;
    }
}

TEST(LensFocus, NothingWhereNoRayPassesOrThePointIsTooNear) {
    const Lens lens = shipped("takumar-50mm-f1.2");
    EXPECT_FALSE(best_film_shift_mm(lens, lens.film_mm(), -INFINITY, 0.));
    EXPECT_FALSE(focused(lens, -INFINITY, FocusBy::Traced, 0.));
    for (const FocusBy by : {FocusBy::Paraxial, FocusBy::Traced}) {
        EXPECT_FALSE(focused(lens, first_order(lens, kLineD_nm).front_focus_mm + 0.01, by));
        EXPECT_FALSE(focused(lens, 10, by));
        EXPECT_FALSE(focused(lens, 200, by));  // light that converges is no object in front
        EXPECT_FALSE(focused(shipped("nikkor-400mm-f2.8-fl"), -300, by));
    }
}

// At the front focus to the last digits of a float the image would lie kilometres behind the lens.
TEST(LensFocus, TheFrontFocusIsTooNear) {
    for (const char* name : {"double-gauss-100mm-f2", "takumar-50mm-f1.2"}) {
        const Lens lens = shipped(name);
        const FirstOrder first = first_order(lens, kLineD_nm);
        EXPECT_FALSE(focused(lens, first.front_focus_mm - 1e-8 * first.focal_length_mm)) << name;
        EXPECT_TRUE(focused(lens, first.front_focus_mm - 0.1 * first.focal_length_mm)) << name;
    }
}

}  // namespace
}  // namespace petzval::camera
