# Installs the build into a throw-away prefix, moves it, then configures, builds and runs the consumer and the
# installed program from there.
#
#     cmake -D BUILD=<build tree> -D SCRATCH=<directory> -D COMPILER=<c++> -D FLAGS=<flags> -P run.cmake
cmake_minimum_required(VERSION 3.25)
set(ENV{LD_LIBRARY_PATH})

function(run)
    execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY COMMAND_ECHO STDOUT)
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/installed)
file(RENAME ${SCRATCH}/installed ${SCRATCH}/moved)

file(GLOB_RECURSE headers RELATIVE ${SCRATCH}/moved/include ${SCRATCH}/moved/include/*)
include(${CMAKE_CURRENT_LIST_DIR}/../../lib/alcove/internal_headers.cmake)
foreach(header IN LISTS alcove_internal_headers)
    if(alcove/${header} IN_LIST headers)
        message(FATAL_ERROR "${header} is internal and was installed")
    endif()
endforeach()

run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${SCRATCH}/build -D CMAKE_PREFIX_PATH=${SCRATCH}/moved
    -D CMAKE_BUILD_TYPE=Release -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_CXX_FLAGS=${FLAGS})
run(${CMAKE_COMMAND} --build ${SCRATCH}/build --parallel)
run(${SCRATCH}/build/consumer)
run(${SCRATCH}/moved/bin/alcove --version)
