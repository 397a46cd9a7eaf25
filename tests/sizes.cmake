# Keeps files readable in one sitting: fails on a source of more than 400 lines, and when half of the headers
# are longer than 120.
#
#     cmake [-D TREE=<checkout>] -P sizes.cmake
cmake_minimum_required(VERSION 3.25)
if(NOT TREE)
    cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH TREE)
endif()
set(longest_source 400)
set(longest_median_header 120)

file(GLOB folders RELATIVE ${TREE} ${TREE}/lib ${TREE}/apps ${TREE}/tests ${TREE}/bench ${TREE}/examples
     ${TREE}/fit ${TREE}/fuzz)
execute_process(COMMAND grep -rc --include=*.h --include=*.cpp "" ${folders}
                WORKING_DIRECTORY ${TREE} OUTPUT_VARIABLE counts RESULT_VARIABLE status)
if(NOT status EQUAL 0)
    message(FATAL_ERROR "no sources found in ${TREE}")
endif()
string(REGEX MATCHALL "[^\n]+:[0-9]+" counts "${counts}")

set(failures)
set(headers)
foreach(count IN LISTS counts)
    string(REGEX MATCH "^(.+):([0-9]+)$" matched ${count})
    set(file ${CMAKE_MATCH_1})
    set(lines ${CMAKE_MATCH_2})
    if(lines GREATER longest_source)
        string(APPEND failures "${file}: ${lines} lines, ${longest_source} at most\n")
    endif()
    if(file MATCHES "\\.h$")
        list(APPEND headers ${lines})
    endif()
endforeach()

list(LENGTH headers header_count)
if(header_count GREATER 0)
    list(SORT headers COMPARE NATURAL)
    math(EXPR middle "${header_count} / 2")
    list(GET headers ${middle} median)
    if(median GREATER longest_median_header)
        string(APPEND failures "the median header has ${median} lines, ${longest_median_header} at most\n")
    endif()
endif()
if(failures)
    message(NOTICE "${failures}")
    message(FATAL_ERROR "Files are too long.")
endif()
list(LENGTH counts count)
message("${count} files are short enough; the median header has ${median} lines")
