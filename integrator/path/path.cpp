// SPDX-License-Identifier: Apache-2.0
#include "integrator/path/path_impl.h"

namespace petzval::integrator {

template class PathTracer<Bvh>;

}  // namespace petzval::integrator
