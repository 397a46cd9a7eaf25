# Installs the build into a temporary prefix, moves it, then configures, builds and runs the consumer from there, and
# runs the installed program.
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
list(FILTER headers INCLUDE REGEX "/detail/|/formats/|/methods/|alcove/nearest/")
if(headers)
    message(FATAL_ERROR "internal headers were installed: ${headers}")
endif()

run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${SCRATCH}/build -D CMAKE_PREFIX_PATH=${SCRATCH}/moved
    -D CMAKE_BUILD_TYPE=Release -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_CXX_FLAGS=${FLAGS})
run(${CMAKE_COMMAND} --build ${SCRATCH}/build --parallel)
run(${SCRATCH}/build/consumer)
run(${SCRATCH}/moved/bin/alcove --version)
