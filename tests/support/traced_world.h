// SPDX-License-Identifier: Apache-2.0
// A scene made of code with the path tracer that looks at it.
#pragma once

#include <memory>

#include "integrator/path/path.h"
#include "tests/support/scenes.h"

namespace petzval::test {

struct TracedWorld : World {
    std::unique_ptr<integrator::PathTracer<>> tracer;

    void finish(int max_depth = integrator::PathOptions().max_depth) {
        World::finish();
        integrator::PathOptions options;
        options.max_depth = max_depth;
        tracer = std::make_unique<integrator::PathTracer<>>(scene, *bvh, *lights, options);
    }
};

}  // namespace petzval::test
