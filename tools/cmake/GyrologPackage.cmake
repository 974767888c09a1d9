# What `cmake --install` puts where, and the Debian package of it (tools/package).
include(GNUInstallDirs)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME gyrolog)
set(CPACK_PACKAGE_CONTACT "The gyrolog authors <maintainers@gyrolog.invalid>" CACHE STRING
  "The package's maintainer, with the address where bugs are told")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "capture, analyse and simulate gyroscopes on an inertial test bench")
set(CPACK_PACKAGE_DESCRIPTION
"gyrolog captures the stream of a microcontroller board with a gyroscope over
USB without losing or inventing a sample, and works out the Allan deviation,
the noise coefficients and the static bias with their uncertainties, with a
figure fit to publish. It simulates sensors from such a noise model, compares
simulation and recording, and diagnoses what the model lacks. A virtual board
stands in where there is no hardware.")
set(CPACK_PACKAGE_HOMEPAGE_URL "" CACHE STRING "The project's page on the web")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
  WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_PACKAGE_VERSION ${PROJECT_VERSION})
# Not Debian's own package, whose revisions begin with 1.
set(CPACK_DEBIAN_PACKAGE_RELEASE 0gyrolog1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# libgyrolog-sensor.so.0: told to other packages, and to the loader's cache.
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
# Figures are lettered with this font; no library asks for it.
# Python only to import the module; the program does without it, but a module needs its interpreter (Debian policy).
set(CPACK_DEBIAN_PACKAGE_DEPENDS "fonts-dejavu-core, python3:any")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
  ${CMAKE_SOURCE_DIR}/tools/debian/postinst ${CMAKE_SOURCE_DIR}/tools/debian/postrm ${CMAKE_SOURCE_DIR}/tools/debian/triggers)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# gyrolog_gzip(FILE): FILE.gz, the same bytes at any time.
function(gyrolog_gzip file)
  execute_process(COMMAND gzip -9n INPUT_FILE ${file} OUTPUT_FILE ${file}.gz COMMAND_ERROR_IS_FATAL ANY)
endfunction()
set(made ${CMAKE_BINARY_DIR}/package)
configure_file(tools/debian/changelog.in ${made}/changelog.Debian @ONLY)
gyrolog_gzip(${made}/changelog.Debian)

install(TARGETS gyrolog)
# Beside bin for any prefix: udev looks into /usr/lib and /usr/local/lib, never into an architecture's folder.
install(FILES tools/60-gyrolog.rules DESTINATION lib/udev/rules.d)
configure_file(tools/debian/lintian-overrides ${made}/lintian/gyrolog COPYONLY)
install(FILES ${made}/lintian/gyrolog DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides)
# Where Debian's Wireshark looks. (Another one looks below its own prefix, and into the user's folders.)
set(wireshark lib/${CMAKE_LIBRARY_ARCHITECTURE}/wireshark)
install(FILES tools/gyrolog.lua DESTINATION ${wireshark}/plugins)
install(PROGRAMS tools/wireshark_extcap DESTINATION ${wireshark}/extcap RENAME gyrolog)
install(DIRECTORY host/formats/schemas DESTINATION ${CMAKE_INSTALL_DATADIR}/gyrolog)
# Made by the program itself, from its commands and options.
set(completions bash-completion/completions/gyrolog zsh/vendor-completions/_gyrolog fish/vendor_completions.d/gyrolog.fish)
foreach(completion IN LISTS completions)
  string(REGEX MATCH "^[a-z]+" shell ${completion})
  set(script ${made}/${completion})
  get_filename_component(folder ${script} DIRECTORY)
  add_custom_command(OUTPUT ${script}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${folder}
    COMMAND gyrolog completion ${shell} > ${script} DEPENDS gyrolog VERBATIM)
  list(APPEND completion_scripts ${script})
  get_filename_component(place ${completion} DIRECTORY)
  install(FILES ${script} DESTINATION ${CMAKE_INSTALL_DATADIR}/${place})
endforeach()
add_custom_target(gyrolog_completions ALL DEPENDS ${completion_scripts})
file(STRINGS host/app/command_line.cpp declared_commands REGEX "^    Command{")
set(pages gyrolog)
foreach(declared IN LISTS declared_commands)
  string(REGEX REPLACE "^    Command{\"([a-z]+)\".*" "gyrolog-\\1" page "${declared}")
  list(APPEND pages ${page})
endforeach()
foreach(page IN LISTS pages)
  string(REGEX REPLACE "^gyrolog-?" "" command ${page})
  set(file ${made}/man/${page}.1)
  add_custom_command(OUTPUT ${file}.gz
    COMMAND ${CMAKE_COMMAND} -E make_directory ${made}/man
    COMMAND gyrolog manual ${command} > ${file}
    COMMAND gzip -9nf ${file} DEPENDS gyrolog VERBATIM)
  list(APPEND manual_pages ${file}.gz)
endforeach()
add_custom_target(gyrolog_manual ALL DEPENDS ${manual_pages})
install(FILES ${manual_pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
set(documents ${CMAKE_INSTALL_DATADIR}/doc/gyrolog)
install(FILES README.md tools/debian/copyright ${made}/changelog.Debian.gz DESTINATION ${documents})
# In their folders, as README.md refers to them.
install(FILES tools/readme.png DESTINATION ${documents}/tools)
install(FILES analysis/METHODS.md DESTINATION ${documents}/analysis)
foreach(document README SPEC DESIGN USB_ID)
  install(FILES firmware_protocol/${document}.md DESTINATION ${documents}/firmware_protocol)
endforeach()
install(FILES host/DESIGN.md DESTINATION ${documents}/host)
install(FILES host/capture/FORMAT.md DESTINATION ${documents}/host/capture)
install(FILES host/formats/MODEL.md DESTINATION ${documents}/host/formats)
install(DIRECTORY tools/fleet DESTINATION ${documents}/tools USE_SOURCE_PERMISSIONS)
install(DIRECTORY host/sensor/examples DESTINATION ${documents})
# What lies elsewhere.
file(MAKE_DIRECTORY ${made}/links)
file(CREATE_LINK ../../examples ${made}/links/examples SYMBOLIC)
install(FILES ${made}/links/examples DESTINATION ${documents}/host/sensor)
file(CREATE_LINK ../../../../gyrolog/schemas ${made}/links/schemas SYMBOLIC)
install(FILES ${made}/links/schemas DESTINATION ${documents}/host/formats)

include(CPack)
