// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace petzval {

/// Limits the threads that OpenEXR starts, which otherwise are as many as the machine has
/// processors, whatever this process may use of them. They do not change a byte.
void limit_picture_threads(int threads);

}  // namespace petzval
