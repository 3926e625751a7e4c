-- Holds the body until the water has come to rest.
function control(t, body)
    if t < 0.399 then return { hold = "shift,turn" } end
    return {}
end
