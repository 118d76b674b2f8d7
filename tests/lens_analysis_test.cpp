// SPDX-License-Identifier: Apache-2.0
// Analyses of lenses against figures that an independent program worked, and against theory.
#include "camera/analysis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "camera/beam.h"
#include "camera/profile.h"
#include "camera/spot.h"
#include "camera/traced_ray.h"
#include "tests/support/lens_json.h"

namespace petzval {
namespace {

using test::kOracleLenses;
using test::read_lens;
using test::read_oracle;

constexpr double kDegree = std::numbers::pi / 180;

Beam aimed(const Lens& lens, const ObjectPoint& object, double nm = kLineD_nm) {
    auto beam = Beam::aim(lens, object, nm);
    if (!beam) throw std::runtime_error("no chief ray");
    return *std::move(beam);
}

class Oracle : public ::testing::TestWithParam<const char*> {
  protected:
    const nlohmann::json oracle = read_oracle(GetParam());
    const Prescription file = read_lens(GetParam());
    const Lens lens{file};
};
INSTANTIATE_TEST_SUITE_P(Lenses, Oracle, ::testing::ValuesIn(kOracleLenses));

TEST_P(Oracle, SpotOnTheAxisAndItsBestFocus) {
    for (const auto& [line, wanted] : oracle.at("axial_spot").items()) {
        const Beam beam = aimed(lens, {}, std::stod(line));
        const auto rays = beam.trace(beam.grid(300), oracle.at("image_plane_z"));
        const double rms = wanted[0], best = wanted[1], rms_at_best = wanted[2];
        EXPECT_NEAR(spot_size(rays).rms_mm, rms, 0.01 * rms) << line;
        EXPECT_NEAR(best_shift_mm(rays), best, 0.01 * std::fabs(best)) << line;
        EXPECT_NEAR(spot_size(rays, best).rms_mm, rms_at_best, 0.01 * rms_at_best) << line;
    }
}

}  // namespace
}  // namespace petzval
