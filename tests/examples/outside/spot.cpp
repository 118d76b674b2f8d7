// SPDX-License-Identifier: Apache-2.0
// Prints the size of a distant point's image:  spot LENS FIELD_DEG
#include <camera/bench/spot.h>
#include <io/lens/lens_file.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

using namespace petzval;

int main(int count, char** words) try {
    if (count != 3) return std::fputs("spot LENS FIELD_DEG\n", stderr), 2;
    const Lens lens(load_lens(words[1]).lens);
    constexpr double kLineD_nm = 587.5618;
    const auto bundle = AimedBundle::aim(lens, {.field_deg = std::atof(words[2])}, kLineD_nm);
    if (!bundle) return std::fputs("no ray reaches the middle of the stop\n", stderr), 1;
    const auto rays = bundle->trace(bundle->grid(64), lens.film_mm());
    if (rays.empty()) return std::fputs("no ray reaches the film\n", stderr), 1;
    const SpotSize size = spot_size(rays);
    std::printf("%zu rays about %.4f mm, root mean square %.4f mm\n", rays.size(),
                size.centroid_mm[1], size.rms_mm);
    return 0;
} catch (const std::exception& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
}
