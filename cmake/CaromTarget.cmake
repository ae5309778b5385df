# What every target of the project has in common: the language, the rules of floating point, warnings, sanitizers.

# carom_configure(TARGET): apply the project's flags.
function(carom_configure target)
    target_compile_features(${target} PUBLIC cxx_std_20)
    # Determinism: a contracted a*b+c rounds once where another compiler rounds twice.
    target_compile_options(${target} PUBLIC $<BUILD_INTERFACE:-ffp-contract=off>
                                            $<INSTALL_INTERFACE:-ffp-contract=off>)
    # Nobody asks for errno or for floating-point traps; without them square roots and choices fit vectors. No bit changes.
    target_compile_options(${target} PRIVATE -fno-math-errno -fno-trapping-math)
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                                             $<$<BOOL:${CAROM_WERROR}>:-Werror>)
    if(CAROM_ARCH)
        target_compile_options(${target} PRIVATE -march=${CAROM_ARCH})
    endif()
    if(CAROM_SANITIZE)
        target_compile_options(${target} PUBLIC $<BUILD_INTERFACE:-fsanitize=${CAROM_SANITIZE};-fno-omit-frame-pointer;-fno-sanitize-recover=all>)
        target_link_options(${target} PUBLIC $<BUILD_INTERFACE:-fsanitize=${CAROM_SANITIZE}>)
    endif()
endfunction()

# carom_add_library(NAME HEADERS ... SOURCES ... LINK ...): the library carom_NAME, alias carom::NAME, whose public headers are
# NAME/include/carom/NAME/*.hpp. A folder's headers reach only the folders that it links.
function(carom_add_library name)
    cmake_parse_arguments(arg "" "" "HEADERS;SOURCES;LINK;LINK_PRIVATE" ${ARGN})
    set(target carom_${name})
    list(TRANSFORM arg_HEADERS PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/include/carom/${name}/)
    add_library(${target} ${arg_SOURCES})
    add_library(carom::${name} ALIAS ${target})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
    target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${CMAKE_CURRENT_SOURCE_DIR}/include FILES ${arg_HEADERS})
    target_link_libraries(${target} PUBLIC ${arg_LINK} PRIVATE ${arg_LINK_PRIVATE})
    carom_configure(${target})
    set_property(GLOBAL APPEND PROPERTY CAROM_LIBRARIES ${target})
endfunction()
