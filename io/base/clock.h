// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace petzval::io {

/// CPU time of all threads of this process so far, seconds.
[[nodiscard]] double process_cpu_s();

}  // namespace petzval::io
