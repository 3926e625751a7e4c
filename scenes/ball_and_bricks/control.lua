-- The plank hangs still, then sinks to the floor or onto a brick, then sweeps against y with its weight on
-- what is below. Speeds are held by forces: proportional to what is missing, never more than params.force,
-- so that the bricks can hold it up.
-- The script remembers nothing: the engine keeps the phase.

local WAIT, SINK, SWEEP, DONE = 1, 2, 3, 4

local function drive(missing, mass)
    local force = 200*mass*missing
    return math.max(-params.force, math.min(params.force, force))
end

function control(t, body)
    local weight, x, v = 9.81*body.mass, body.position, body.velocity
    if body.phase == WAIT then
        if t >= params.wait then return { phase = SINK, hold = "shift" } end
        return { hold = "shift" }
    elseif body.phase == SINK then
        local landed = body.phase_time > 0.5 and math.abs(v[3]) < 0.01
        if x[3] <= 0.12 or landed then return { phase = SWEEP } end
        return { force = { 0, 0, weight + drive(-1 - v[3], body.mass) }, hold = "y" }
    elseif body.phase == SWEEP then
        if x[2] <= 0.5 then return { phase = DONE, hold = "shift" } end
        return { force = { 0, drive(-params.speed - v[2], body.mass), 0 } }
    end
    return { hold = "shift" }
end
