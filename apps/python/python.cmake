# SPDX-License-Identifier: Apache-2.0
# Python's module: build/python/petzval, for PYTHONPATH=build/python.
set(python_folder ${CMAKE_BINARY_DIR}/python/petzval)
file(MAKE_DIRECTORY ${python_folder})
file(GLOB python_files CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR}/apps/python/petzval
    apps/python/petzval/*.py apps/python/petzval/py.typed)
foreach(file ${python_files})
    file(CREATE_LINK ${CMAKE_SOURCE_DIR}/apps/python/petzval/${file} ${python_folder}/${file} SYMBOLIC)
endforeach()

add_library(petzval_python_core MODULE apps/python/main.cpp apps/processor.cpp)
target_link_libraries(petzval_python_core PRIVATE petzval_apps_python ${CMAKE_DL_LIBS})
# Of all that it holds it shows Python one function.
target_link_options(petzval_python_core PRIVATE -Wl,--exclude-libs,ALL)
set_target_properties(petzval_python_core PROPERTIES PREFIX "" OUTPUT_NAME _core
    SUFFIX ".${Python3_SOABI}.so" CXX_VISIBILITY_PRESET hidden LIBRARY_OUTPUT_DIRECTORY ${python_folder})
target_compile_options(petzval_apps_python PRIVATE -fvisibility=hidden)

# Functions with a keyword for each field, from the table of fields. A module with sanitizers is for programs
# that have them.
set(python_fields ${python_folder}/_fields.py)
if(NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    add_custom_command(OUTPUT ${python_fields}
        COMMAND Python3::Interpreter ${CMAKE_SOURCE_DIR}/apps/python/make_fields.py
            $<TARGET_FILE:petzval_python_core> ${python_fields}
        DEPENDS petzval_python_core apps/python/make_fields.py COMMENT "Writing ${python_fields}" VERBATIM)
    add_custom_target(petzval_python ALL DEPENDS ${python_fields})
endif()

# Debian's Python looks in python3/dist-packages for packages, and in a folder of its version below /usr/local.
set(python_installed ${python_fields} $<TARGET_FILE:petzval_python_core>)
foreach(file ${python_files})
    list(APPEND python_installed ${CMAKE_SOURCE_DIR}/apps/python/petzval/${file})
endforeach()
install(CODE "set(versioned python${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR})
    if(CMAKE_INSTALL_PREFIX STREQUAL \"/usr\")
        set(versioned python${Python3_VERSION_MAJOR})
    endif()
    set(folder \"\${CMAKE_INSTALL_PREFIX}/lib/\${versioned}/dist-packages/petzval\")
    if(EXISTS \"${python_fields}\")
        file(INSTALL ${python_installed} DESTINATION \"\${folder}\")
        if(CMAKE_INSTALL_DO_STRIP)
            execute_process(COMMAND ${CMAKE_STRIP} \"\$ENV{DESTDIR}\${folder}/$<TARGET_FILE_NAME:petzval_python_core>\")
        endif()
    endif()"
    COMPONENT python)
