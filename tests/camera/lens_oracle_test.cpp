// SPDX-License-Identifier: Apache-2.0
// Rays that an independent program traced in float64 and in 34 digits: tests/data/oracle.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "camera/lens/trace.h"
#include "tests/support/lens_json.h"
#include "tests/support/lens_rays.h"

namespace petzval::camera {
namespace {

using test::at_lane;
using test::kOracleLenses;
using test::read_lens;
using test::read_oracle;
using test::Three;
using test::vectors_of;
using test::whole;

struct End {
    std::string status;
    int surface;
};

/// A line of the oracle's tables.
struct Row {
    double nm;
    Three origin, direction;
    End clipped;
    double margin_mm;  ///< least distance from an edge, large where it is not known
    End unclipped;
    bool leaves;  ///< there is a ray on the far side where apertures are not obeyed
    Three point, leaving;
    double path_mm;
    std::optional<std::array<double, 2>> image;
};

std::vector<Row> rows_of(const nlohmann::json& table) {
    std::vector<Row> rows;
    for (const auto& item : table) {
        Row row{item[0], item[1], item[2], {item[3], item[4]}, 1e9, {item[6], item[7]}, false, {},
                {},      0,       {}};
        if (item[5].is_number()) row.margin_mm = item[5];
        if (item.size() > 8) {
            row.leaves = true;
            row.point = item[8], row.leaving = item[9], row.path_mm = item[10];
            if (item[11].is_array()) row.image = item[11].get<std::array<double, 2>>();
        }
        rows.push_back(row);
    }
    return rows;
}

const char* name_of(RayStatus status) {
    constexpr const char* names[] = {"ok", "vignetted", "TIR", "miss"};
    return names[static_cast<int>(status)];
}

double distance(Three a, Three b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

template <class V>
struct Worst {
    double point_mm = 0, direction = 0, image_mm = 0, path_mm = 0;
    int passed = 0, blocked = 0;
};

/// Traces all rows, four at a time, and compares with what they say.
template <class V>
Worst<V> compare(const Lens& lens, const std::vector<Row>& rows, Towards towards, Clip clip,
                 double film_mm) {
    Worst<V> worst;
    const int begin = towards == Towards::Film ? 0 : lens.last();
    const int end = lens.last() - begin;
    for (size_t first = 0; first < rows.size(); first += 4) {
        const auto row = [&](int i) -> const Row& {
            return rows[std::min(first + size_t(i), rows.size() - 1)];
        };
        LensRay<V> ray;
        ray.counted_from = begin;
        ray.origin = vectors_of<V>([&](int i) {
            Three origin = row(i).origin;
            origin[2] -= lens.vertex_mm(begin);
            return origin;
        });
        ray.direction = vectors_of<V>([&](int i) { return test::unit(row(i).direction); });
        const auto indices =
            lens.exact_indices(test::lanes_of<V>([&](int i) { return row(i).nm; }));
        V path{};
        const auto add_path = [&path](const LensHit<V>& hit) {
            path = select(hit.reached, V(path + hit.index * hit.distance_mm), path);
        };
        const auto passed = trace_lens({lens, towards, whole(lens), clip}, indices, ray, add_path);
        for (int i = 0; i < 4 && first + size_t(i) < rows.size(); ++i) {
            const Row& wanted = row(i);
            const End& end_wanted = clip == Clip::Yes ? wanted.clipped : wanted.unclipped;
            if (clip == Clip::Yes && sizeof(V) == sizeof(f4) && wanted.margin_mm < 1e-3) continue;
            const auto where = [&] {
                return ::testing::Message() << "row " << first + size_t(i) << ' ' << wanted.nm;
            };
            EXPECT_EQ(name_of(ray.status(i)), end_wanted.status) << where();
            EXPECT_EQ(passed[i] != 0, end_wanted.status == "ok") << where();
            if (end_wanted.status != "ok") {
                EXPECT_EQ(ray.end_surface[i], end_wanted.surface) << where();
                EXPECT_EQ(at_lane(ray.origin, i), (Three{})) << "on the axis: " << where();
                ++worst.blocked;
                continue;
            }
            ++worst.passed;
            Three point = at_lane(ray.origin, i);
            const Three leaving = at_lane(ray.direction, i);
            point[2] += lens.vertex_mm(end);
            const auto take = [](double& greatest, double error) {
                greatest = std::max(greatest, error);
            };
            take(worst.point_mm, distance(point, wanted.point));
            take(worst.direction, distance(leaving, wanted.leaving));
            take(worst.path_mm, std::fabs(double(path[i]) - wanted.path_mm));
            if (!wanted.image) continue;
            const double t = (film_mm - point[2]) / leaving[2];
            take(worst.image_mm, std::hypot(point[0] + t * leaving[0] - (*wanted.image)[0],
                                            point[1] + t * leaving[1] - (*wanted.image)[1]));
        }
    }
    return worst;
}

class OracleRays : public ::testing::TestWithParam<const char*> {
  protected:
    const nlohmann::json oracle = read_oracle(GetParam());
    const Lens lens{read_lens(GetParam())};
    const std::vector<Row> forward = rows_of(oracle.at("forward")),
                           reverse = rows_of(oracle.at("reverse"));

    template <class V>
    void compare_all(double point_mm, double direction, double path_mm) const {
        const double film_mm = oracle.at("image_plane_z");
        for (const auto clip : {Clip::Yes, Clip::No})
            for (const auto towards : {Towards::Film, Towards::Scene}) {
                const auto& rows = towards == Towards::Film ? forward : reverse;
                const auto worst = compare<V>(lens, rows, towards, clip, film_mm);
                SCOPED_TRACE(::testing::Message() << "to film " << (towards == Towards::Film)
                                                  << ", clip " << (clip == Clip::Yes));
                EXPECT_LT(worst.point_mm, point_mm);
                EXPECT_LT(worst.image_mm, point_mm);
                EXPECT_LT(worst.direction, direction);
                EXPECT_LT(worst.path_mm, path_mm);
                EXPECT_GT(worst.passed, 80);
            }
    }
};
INSTANTIATE_TEST_SUITE_P(Lenses, OracleRays, ::testing::ValuesIn(kOracleLenses));

TEST_P(OracleRays, RaysInDoubles) {
    compare_all<d4>(1e-9, 1e-11, 1e-9);
}

TEST_P(OracleRays, RaysInFloats) {
    compare_all<f4>(1e-4, 1e-5, 1e-3);
}

}  // namespace
}  // namespace petzval::camera
