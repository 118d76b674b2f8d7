#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Removes what was installed last, and the folders of its own that are empty then:
#
#   [DESTDIR=...] apps/package/uninstall.sh LIST
#
# LIST: the install_manifest.txt that cmake --install wrote.
set -euo pipefail
while read -r file || [[ -n $file ]]; do
    file=${DESTDIR:-}$file
    rm -f "$file"
    [[ $file != *.py ]] || rm -rf "${file%/*}/__pycache__"
    folder=${file%/*}
    while [[ $folder =~ /(lib|python3-)?[Pp]etzval(-dev|-doc|/|$) ]]; do
        rmdir "$folder" 2> /dev/null || break
        folder=${folder%/*}
    done
done < "$1"
