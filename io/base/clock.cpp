// SPDX-License-Identifier: Apache-2.0
#include "io/base/clock.h"

#include <sys/resource.h>

namespace petzval::io {

double process_cpu_s() {
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    rusage self{};
    getrusage(RUSAGE_SELF, &self);
    return seconds(self.ru_utime) + seconds(self.ru_stime);
}

}  // namespace petzval::io
