// SPDX-License-Identifier: Apache-2.0
#include "integrator/render/render.h"

#include "integrator/render/executor.h"

namespace petzval {

template class SampleBatch<PathTracer<>>;
template RenderResult render(const PathTracer<>&, const Camera&, const RenderJob&, Film&,
                             TbbExecutor&, RenderMonitor&);

}  // namespace petzval
