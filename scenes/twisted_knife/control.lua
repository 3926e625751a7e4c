-- The knife goes down at params.speed (m/s) with at most params.force (N), until its centre of mass has
-- come down by 5 mm of air and params.depth (m); then a torque about its edge (y) rises to params.torque
-- (N m) within params.rise (s). Its centre stands in the second phase; turns other than that one are held.

local PUSH, TWIST = 1, 2
local START = 0.165 - 0.0480278         -- m, height of the centre of mass at the start

function control(t, body)
    local weight = 9.81*body.mass
    if body.phase == PUSH and body.position[3] > START - 0.005 - params.depth then
        local missing = -params.speed - body.velocity[3]
        local push = math.max(-params.force, math.min(params.force, 3000*body.mass*missing))
        return { force = { 0, 0, weight + push }, hold = "x,y,turn" }
    end
    local since = body.phase == TWIST and body.phase_time or 0
    local torque = params.torque*math.min(1, since/params.rise)
    return { force = { 0, 0, weight }, torque = { 0, torque, 0 }, phase = TWIST,
             hold = "shift,turn_x,turn_z" }
end
