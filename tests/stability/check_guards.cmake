# SPDX-License-Identifier: Apache-2.0
# Checks that ctest lists every test that GUARDS names, and runs it:
#
#   cmake -D CTEST=ctest -D BUILD=folder -D GUARDS=guards.csv -P check_guards.cmake
cmake_minimum_required(VERSION 3.25)
# From a folder of its own: where a ctest runs, another one would overwrite its log.
set(beside ${BUILD}/guards)
file(WRITE ${beside}/CTestTestfile.cmake "subdirs(\"${BUILD}\")\n")
execute_process(COMMAND ${CTEST} -N WORKING_DIRECTORY ${beside}
    OUTPUT_VARIABLE list RESULT_VARIABLE failed)
if(failed)
    message(FATAL_ERROR "ctest -N fails in ${BUILD}")
endif()
string(REGEX MATCHALL "Test +#[0-9]+: [^\n]+" lines "${list}")
set(tests)
foreach(line ${lines})
    if(NOT line MATCHES "Disabled")
        string(REGEX REPLACE "^Test +#[0-9]+: " "" name "${line}")
        # Instances of a test with parameters are Instance/Suite.Name/0.
        string(REGEX REPLACE "^[^./]+/" "" name "${name}")
        string(REGEX REPLACE "/[^/]*$" "" name "${name}")
        list(APPEND tests ${name})
    endif()
endforeach()

file(STRINGS ${GUARDS} rows REGEX "^[^#].*,")
list(POP_FRONT rows)  # the names of the columns
set(count 0)
foreach(row ${rows})
    string(REGEX REPLACE "^[^,]*," "" names ${row})
    separate_arguments(names)
    foreach(name ${names})
        math(EXPR count "${count} + 1")
        if(NOT name IN_LIST tests)
            message(SEND_ERROR "ctest has no test ${name}, or it is disabled: ${row}")
        endif()
    endforeach()
endforeach()
if(count EQUAL 0)
    message(SEND_ERROR "${GUARDS} names no test")
endif()
message(STATUS "${count} guards are among ctest's tests")
