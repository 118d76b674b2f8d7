// SPDX-License-Identifier: Apache-2.0
#include "camera/lens_camera.h"

#include <gtest/gtest.h>

#include "camera/paraxial.h"
#include "tests/support/lens_json.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

using test::read_lens;
using test::read_oracle;

struct Setup {
    ApertureShape shape = Disk{};
    Chroma chroma = Chroma::Shared;
    double stop_scale = 1;  ///< of the filed radius
};

LensCamera camera_of(const std::string& name, const Setup& setup = {}) {
    const auto lens = std::make_shared<const Lens>(read_lens(name));
    const double radius =
        lens->prescription().surfaces[size_t(lens->stop())].semi_diameter_mm * setup.stop_scale;
    LensCameraInput in{.lens = lens, .iris = Iris(setup.shape, radius), .to_world = M44f()};
    in.film_mm = read_oracle(name).at("image_plane_z");
    in.entrance_pupil_mm = first_order(*lens, kLineD_nm).entrance_pupil_mm;
    in.chroma = setup.chroma;
    return LensCamera(std::move(in));
}

// Mean weight over stratified draws: irradiance over radiance at a film point.
double irradiance(const LensCamera& camera, V2f film_mm, int side = 128) {
    double sum = 0;
    test::Random random(5);
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const V2f u((float(i) + random.next()) / float(side),
                        (float(j) + random.next()) / float(side));
            sum += camera
                       .draw(film_mm, V2f(std::min(u.x, kOneMinus), std::min(u.y, kOneMinus)), 0,
                             Bands::rgb())
                       .weight[0];
        }
    return sum / (double(side) * side);
}

TEST(LensCamera, IrradianceIsTheOracles) {
    for (const std::string name : test::kOracleLenses) {
        const LensCamera camera = camera_of(name);
        const auto table = read_oracle(name).at("irradiance");
        ASSERT_FALSE(table.empty());
        for (const auto& row : table) {
            const double height = row.at(0), expected = row.at(1);
            EXPECT_NEAR(irradiance(camera, V2f(0, float(height))), expected, 0.002 * expected)
                << name << ' ' << height;
        }
    }
}

}  // namespace
}  // namespace petzval
