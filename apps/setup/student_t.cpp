// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/student_t.h"

namespace petzval::apps {

double student_t_975(double degrees) {
    if (degrees < 3) return degrees < 2 ? 12.706 : 4.303;  // too few for the series
    constexpr double z = 1.959963984540054;
    constexpr double z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z, z9 = z7 * z * z;
    const double n = 1 / degrees;
    return z + n * ((z3 + z) / 4 +
                    n * ((5 * z5 + 16 * z3 + 3 * z) / 96 +
                         n * ((3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / 384 +
                              n * (79 * z9 + 776 * z7 + 1482 * z5 - 1920 * z3 - 945 * z) / 92160)));
}

}  // namespace petzval::apps
