// SPDX-License-Identifier: Apache-2.0
// A ray and what it hits: the records that bvh, camera and integrator exchange.
#pragma once

#include <array>
#include <cstdint>

#include "core/math/math.h"
#include "core/math/steps.h"

namespace petzval {

/// BLEND surfaces that a ray has passed, each with what it lets through: a few, kMost. A ray that
/// is cast with them does not meet them again.
struct PassedBlends {
    static constexpr size_t kMost = 8;
    struct Passed {
        uint32_t instance, triangle;
        float left;  ///< share of the light that goes on behind it
    };
    std::array<Passed, kMost> passed;
    size_t count = 0;
    bool all = false;  ///< all that there are, whether in the list or not
    float t_min = 0;   ///< of the ray: nothing that is to be found lies nearer

    [[nodiscard]] bool full() const { return count == kMost; }
    [[nodiscard]] bool has(uint32_t instance, uint32_t triangle) const {
        for (size_t i = 0; i < count; ++i)
            if (passed[i].triangle == triangle && passed[i].instance == instance) return true;
        return all;
    }
    void clear() { count = 0, t_min = 0; }
    void add(const Passed& p) { passed[count++] = p; }
};

struct Ray {
    V3f origin;
    V3f direction;  ///< unit length for rays that measure distance; t counts in its length
    float t_max = kInfinity;
    /// Seed of BLEND coverage: the same seed and triangle give the same answer.
    uint32_t alpha_seed = 0;
    float time = kMiddleOfShutter;  ///< core/math/steps.h
};

/// A triangle hit, as the traversal reports it; Surface (core/shading/surface.h) has the rest.
struct Hit {
    V2f barycentric;  ///< weights of the second and third vertex
    uint32_t instance, triangle;
    float time = kMiddleOfShutter;  ///< of the ray
};

}  // namespace petzval
