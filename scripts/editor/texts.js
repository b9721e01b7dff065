'use strict'

const SHARED = '@nxline/node-red-serial-plc/plc-line:'

/** A text of the shared part of the catalogue, in the language of the browser. */
const t = (key, values) => RED._(`${SHARED}${key}`, values)

/** The text of an error with a code, translated if the catalogue has it; `reason` stays as the library gives it. */
const errorText = error => {
  if (!error.code) return String(error.message || error)
  const key = `${SHARED}error.${error.code}`
  const text = RED._(key, { ...error.details, defaultValue: error.message })
  return text && !text.endsWith(`error.${error.code}`) ? text : error.message
}

/** What a bad address cell says: the innermost reason, since the row already names itself. */
const reasonOf = error => errorText(error.cause && error.cause.code ? error.cause : error)

module.exports = { t, errorText, reasonOf }
