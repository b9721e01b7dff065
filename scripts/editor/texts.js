'use strict'

const SHARED = '@nxline/node-red-serial-plc/plc-line:'

/** A text of the shared part of the catalogue, in the language of the browser. */
const t = (key, values) => RED._(`${SHARED}${key}`, values)

/** The text of an error with a code, in the language of the browser if its catalogue has the code; `reason` stays as the library gives it. */
const errorText = error => {
  const text = String(error.message || error)
  if (!error.code || !error.details) return text
  const translated = RED._(`${SHARED}error.${error.code}`, { ...error.details, defaultValue: text })
  // a detail that did not come with the error would leave a hole
  return /__\w+__/.test(translated) ? text : translated
}

/** What a bad address cell says: the innermost reason, since the row already names itself. */
const reasonOf = error => errorText(error.cause && error.cause.code ? error.cause : error)

module.exports = { t, errorText, reasonOf }
