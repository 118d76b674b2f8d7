// SPDX-License-Identifier: Apache-2.0
// Ghosts pair by pair, drawn from the film, against walks of light from the scene through the lens;
// and how many times as efficient regions are as draws over the pairs and the last surface, which
// know nothing of the lamp. Uncoated, the stop wide open, a sun of 0.53 degrees, line d.
//
//   ghost_pairs LENS DEGREES [DRAWS [WALKS]]
#include <fmt/format.h>

#include <cstdlib>

#include "tests/measure/ghost_light.h"

namespace petzval {
namespace {

int main_of(int count, char** words) {
    if (count < 3) {
        fmt::print(stderr, "ghost_pairs LENS DEGREES [DRAWS [WALKS]]\n");
        return 2;
    }
    constexpr float kSunRadius = 0.53f / 2 * kDegree_rad;
    const test::GhostLight ghosts(test::ghostly(words[1], camera::Coating::Uncoated),
                                  test::sun_at(std::atof(words[2]), kSunRadius));
    const auto number = [&](int i, uint32_t other) {
        return count > i ? uint32_t(std::atoi(words[i])) : other;
    };
    const uint32_t draws = number(3, 4'000'000), walks = number(4, 400'000);
    test::PairLights pairs;
    ghosts.walk(walks, pairs);
    ghosts.draw(draws, pairs);
    double walked = 0, drawn = 0, rest = 0, rest_drawn = 0, variance = 0, worst_sigma = 0;
    double squares = 0, blind_squares = 0;
    int large = 0, unseen = 0;
    for (const auto& [pair, light] : pairs) walked += light.walked / walks;
    for (const auto& [pair, light] : pairs) {
        const double a = light.walked / walks, b = light.drawn / draws;
        drawn += b;
        unseen += light.unseen;
        variance += light.error2(walks, draws);
        squares += light.drawn_squares / walks, blind_squares += light.blind_squares / walks;
        if (a < 1e-3 * walked) {
            rest += a, rest_drawn += b;
            continue;
        }
        ++large;
        const double sigma = std::sqrt(light.error2(walks, draws));
        worst_sigma = std::max(worst_sigma, std::fabs(b - a) / sigma);
        fmt::print("  {:2},{:2}  {:7.4f} of the light  {:+6.2f} % +- {:.2f} %\n", pair.first,
                   pair.second, a / walked, 100 * (b / a - 1), 100 * sigma / a);
    }
    fmt::print(
        "{}: {} pairs above a thousandth, off by {:.1f} standard errors at most; the rest, {:.4f} "
        "of the light, {:+.2f} %; all {:+.2f} % +- {:.2f} %; {} rays unseen; regions have {:.0f} "
        "times the efficiency\n",
        words[1], large, worst_sigma, rest / walked, 100 * (rest_drawn / rest - 1),
        100 * (drawn / walked - 1), 100 * std::sqrt(variance) / walked, unseen,
        (blind_squares - walked * walked) / (squares - walked * walked));
    return 0;
}

}  // namespace
}  // namespace petzval

int main(int count, char** words) {
    return petzval::main_of(count, words);
}
