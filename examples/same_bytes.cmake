# Bakes a mesh with the OpenMesh example and with the program, and compares the files. nonmanifold.off is three squares
# that share an edge.
set(file ${ARCHIVE}/${MESH})
if(MESH STREQUAL nonmanifold.off)
    set(file ${CMAKE_CURRENT_BINARY_DIR}/nonmanifold.off)
    file(WRITE ${file} "OFF\n8 3 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 -1 0\n1 -1 0\n0 0 1\n1 0 1\n"
         "4 0 1 3 2\n4 4 5 1 0\n4 0 1 7 6\n")
endif()
execute_process(COMMAND ${EXAMPLE} ${file} ${MESH}.by_example.ply COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${PROGRAM} bake ${file} -o ${MESH}.by_program.ply --quiet COMMAND_ERROR_IS_FATAL ANY)
file(SHA256 ${MESH}.by_example.ply example)
file(SHA256 ${MESH}.by_program.ply program)
if(NOT example STREQUAL program)
    message(FATAL_ERROR "${MESH}: the example and the program write different bytes")
endif()
