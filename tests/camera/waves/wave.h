// SPDX-License-Identifier: Apache-2.0
// Waves of a lens, as the tests of this folder want them.
#pragma once

#include <stdexcept>

#include "camera/waves/point_spread.h"
#include "camera/waves/wavefront.h"

namespace petzval::test {

/// A bundle and its pupil function about the centroid of its rays.
struct TestWave {
    camera::AimedBundle bundle;
    camera::PupilFunction pupil;
};
inline TestWave wave_of(const camera::Lens& lens, const camera::ObjectPoint& object = {},
                        double film_shift_mm = 0, int side = 0, double nm = kLineD_nm) {
    const auto bundle = camera::AimedBundle::aim(lens, object, nm);
    if (!bundle) throw std::runtime_error("no chief ray");
    const double film_mm = lens.film_mm() + film_shift_mm;
    const auto image_mm = camera::image_point(*bundle, film_mm);
    if (!image_mm) throw std::runtime_error("no light");
    const camera::ReferenceSphere sphere = camera::reference_sphere(*bundle, film_mm, *image_mm);
    const auto grid = camera::pupil_grid(*bundle, sphere);
    if (!grid) throw std::runtime_error("no light");
    return {*bundle,
            camera::pupil_function(*bundle, sphere, side > 0 ? grid->with_side(side) : *grid)};
}

}  // namespace petzval::test
