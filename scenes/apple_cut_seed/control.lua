-- The knife presses down with a force that grows by params.rate (N/s) from the start, until its centre of
-- mass is at params.stop (m); then it stays at that height and slides along -y with params.slide of the
-- force, up to params.speed. The script remembers nothing: the engine keeps the phase.

local PRESS, SLIDE = 1, 2
local NEAR = 1e-4                       -- m: the board may hold the edge a hair above the stop

function control(t, body)
    local force = params.rate*t
    if body.phase == PRESS and body.position[3] > params.stop + NEAR then
        return { force = { 0, 0, -force } }
    end
    local push = body.velocity[2] > -params.speed and -params.slide*force or 0
    return { force = { 0, push, 0 }, phase = SLIDE, hold = "z" }
end
