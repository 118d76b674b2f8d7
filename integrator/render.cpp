// SPDX-License-Identifier: Apache-2.0
#include "integrator/render.h"

#include "integrator/executor.h"

namespace petzval {

template class SampleBatch<PathTracer<>>;
template RenderResult render(const PathTracer<>&, const Camera&, const RenderJob&, Film&,
                             TbbExecutor&, RenderMonitor&);

}  // namespace petzval
