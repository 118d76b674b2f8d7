// SPDX-License-Identifier: Apache-2.0
#include "integrator/render/render.h"

#include "integrator/render/executor.h"
#include "integrator/render/render_to_noise.h"

namespace petzval::integrator {

template class SampleBatch<PathTracer<>>;
template RenderResult render(const PathTracer<>&, const camera::Camera&, const RenderJob&, Film&,
                             TbbExecutor&, RenderMonitor&);
template RenderResult render_to_noise(const PathTracer<>&, const camera::Camera&, const RenderJob&,
                                      Film&, TbbExecutor&, RenderMonitor&);

}  // namespace petzval::integrator
