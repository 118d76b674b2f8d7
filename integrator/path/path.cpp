// SPDX-License-Identifier: Apache-2.0
#include "integrator/path/path_impl.h"

namespace petzval {

template class PathTracer<Bvh>;

}  // namespace petzval
