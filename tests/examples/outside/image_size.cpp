// SPDX-License-Identifier: Apache-2.0
#include "image_size.h"

#include <camera/bench/spot.h>
#include <fmt/format.h>
#include <io/lens/lens_file.h>

#include <stdexcept>

using namespace petzval;

std::string image_size(const std::string& lens_name, double field_deg) {
    const camera::Lens lens(io::load_lens(lens_name).lens);
    constexpr double kLineD_nm = 587.5618;
    const auto bundle = camera::AimedBundle::aim(lens, {.field_deg = field_deg}, kLineD_nm);
    if (!bundle) throw std::runtime_error("no ray reaches the middle of the stop");
    const auto rays = bundle->trace(bundle->grid(64), lens.film_mm());
    if (rays.empty()) throw std::runtime_error("no ray reaches the film");
    const camera::SpotSize size = camera::spot_size(rays);
    return fmt::format("{} rays about {:.4f} mm, root mean square {:.4f} mm", rays.size(),
                       size.centroid_mm[1], size.rms_mm);
}
