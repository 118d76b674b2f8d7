#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Runs a file of tests with the Python module of a build. Skipped, saying why, without what it needs.
#
#   run.sh BUILD_FOLDER test_FILE.py
set -euo pipefail
cd "$(dirname "$0")"
build=$1 file=$2
skip() {
    echo "skipped: $1"
    exit 77
}
[[ -f $build/python/petzval/_fields.py ]] ||
    skip "Python's module is not built; pybind11-dev and python3-dev are needed, and no sanitizers"
python=$(sed -n 's/^_Python3_EXECUTABLE:INTERNAL=//p' "$build/CMakeCache.txt")
"$python" -c "import pytest" 2> /dev/null || skip "pytest is not installed; python3-pytest has it"
export PYTHONPATH=$build/python PYTHONDONTWRITEBYTECODE=1 PETZVAL_PROGRAM=$build/bin/petzval
# -rs names what is skipped.
exec "$python" -m pytest -q -rs -p no:cacheprovider "$file"
