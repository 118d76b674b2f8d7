// SPDX-License-Identifier: Apache-2.0
#include "camera/setup/lens_bench.h"

#include "camera/lens/focus.h"
#include "camera/lens/paraxial.h"
#include "camera/setup/focused_lens.h"

namespace petzval::camera {

std::optional<LensBench> LensBench::focused(const Lens& lens, double distance_mm, FocusBy by) {
    auto sharp = focused_from_pupil(lens, distance_mm, by);
    if (!sharp) return std::nullopt;
    LensBench out(std::make_shared<const Lens>(std::move(sharp->lens)));
    out.distance_mm = distance_mm;
    return out;
}

std::optional<double> LensBench::best_film_shift_mm() const {
    const double pupil_mm = first_order(*lens, kLineD_nm).entrance_pupil_mm;
    return camera::best_film_shift_mm(*lens, film_mm, pupil_mm - distance_mm);
}

}  // namespace petzval::camera
