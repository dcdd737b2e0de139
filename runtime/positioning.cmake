# Positioning of one axis: ramp generator, position controller, reference travels, modulo, touch probes, cams. Pure
# arithmetic on integers; it knows neither drive nor bus.
ipos_layer(positioning FOLDERS runtime/positioning
           SOURCES positioning/ramp_shape.cpp positioning/profile.cpp positioning/settings.cpp positioning/encoders.cpp
                   positioning/modulo.cpp positioning/touch_probe.cpp positioning/reference_travel.cpp
                   positioning/cams.cpp positioning/positioner.cpp positioning/positioner_reference.cpp
                   positioning/follower.cpp positioning/synchronous.cpp positioning/positioner_follow.cpp
           USES part)
