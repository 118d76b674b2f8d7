# SPDX-License-Identifier: Apache-2.0
# Writes FACTS, the header of what the program is built from, unless it says so already. Run at build
# time, whenever a source has changed, and without git.
#
#   cmake -D LIST=... -D TEMPLATE=... -D FACTS=... -P sources.cmake
#
# LIST: a file with the names of the sources, one a line, relative to the folder above this one's.
# TEMPLATE: the header, with @kBuildSources@ where their hash goes.
cmake_path(SET root NORMALIZE ${CMAKE_CURRENT_LIST_DIR}/../..)
file(STRINGS ${LIST} sources ENCODING UTF-8)
foreach(source IN LISTS sources)
    file(SHA256 ${root}/${source} hash)
    string(APPEND all "${hash} ${source}\n")
endforeach()
string(SHA256 kBuildSources "${all}")
configure_file(${TEMPLATE} ${FACTS} @ONLY)
